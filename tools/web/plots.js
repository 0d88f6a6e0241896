// Plots as SVG: how many loops there are above a persistence, and the persistence diagram.
import { count, digitsFor, distinctNumbers, shortNumber } from './data.js'

const kWidth = 560
const kHeight = 400
const kFrame = { left: 64, right: 16, top: 36, bottom: 52 }

const inner = { width: kWidth - kFrame.left - kFrame.right, height: kHeight - kFrame.top - kFrame.bottom }
const xAt = (part) => kFrame.left + part * inner.width
const yAt = (part) => kHeight - kFrame.bottom - part * inner.height

function element(name, attributes, text = '') {
  const list = Object.entries(attributes).map(([key, value]) => ` ${key}="${value}"`)
  return `<${name}${list.join('')}>${text}</${name}>`
}

// Names can have any characters.
function safe(text) {
  return text.replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`)
}

function axes(title, x, y) {
  const parts = [
    element('text', { class: 'title', x: kFrame.left, y: 20 }, title),
    element('text', { x: xAt(0.5), y: kHeight - 10, 'text-anchor': 'middle' }, x.title),
    element('text', { transform: `translate(16 ${yAt(0.5)}) rotate(-90)`, 'text-anchor': 'middle' }, y.title),
  ]
  for (const { at, text } of x.ticks) {
    parts.push(element('path', { class: 'grid', d: `M${xAt(at)} ${yAt(0)}V${yAt(1)}` }))
    parts.push(element('text', { class: 'quiet', x: xAt(at), y: yAt(0) + 18, 'text-anchor': 'middle' }, text))
  }
  for (const { at, text } of y.ticks) {
    parts.push(element('path', { class: 'grid', d: `M${xAt(0)} ${yAt(at)}H${xAt(1)}` }))
    parts.push(element('text', { class: 'quiet', x: xAt(0) - 8, y: yAt(at) + 4, 'text-anchor': 'end' }, text))
  }
  parts.push(element('path', { class: 'axis', d: `M${xAt(0)} ${yAt(1)}V${yAt(0)}H${xAt(1)}` }))
  return parts.join('')
}

function figure(name, content, legend, caption, description) {
  const made = document.createElement('figure')
  made.id = name
  made.innerHTML =
    `<svg class="plot" viewBox="0 0 ${kWidth} ${kHeight}" role="img" aria-label="${safe(description)}">${content}</svg>` +
    legend +
    element('figcaption', {}, safe(caption))
  return made
}

function powerText(exponent) {
  return exponent >= -3 && exponent <= 4 ? String(Number(`1e${exponent}`)) : `10<tspan dy="-5" font-size="9">${exponent}</tspan>`
}

// From a power of ten, or from `floor` below it.
function logScale(least, most, floor = least) {
  const low = Math.floor(Math.log10(least) + 1e-9)
  let high = Math.ceil(Math.log10(most) - 1e-9)
  if (high <= low) high = low + 1
  const begin = Math.min(low, Math.log10(floor))
  const place = (exponent) => (exponent - begin) / (high - begin)
  const step = Math.ceil((high - low) / 8)
  const ticks = []
  for (let e = low; e <= high; e += step) ticks.push({ at: place(e), text: powerText(e) })
  // Few powers leave room for more.
  if (high - low <= 2)
    for (let e = low; e < high; ++e)
      for (const digit of [2, 5]) ticks.push({ at: place(e + Math.log10(digit)), text: String(Number(`${digit}e${e}`)) })
  return { ticks, at: (value) => place(Math.log10(value)) }
}

const kLeastLoops = 0.7 // the lower end of the axis, as in `reeb plot`; zero has no place on it

// `steps`: [persistence, number of loops of at least this persistence], the largest persistence first. `known`: loops of
// more persistence are all among them, so the curve ends there; `more`: what would load others.
export function loopsPlot(steps, range, known = 0, more = '') {
  const shown = steps.filter(([persistence]) => persistence > known).map(([p, n]) => [(100 * p) / range, n])
  if (shown.length === 0) return null
  const isPart = known > 0
  const least = isPart ? (100 * known) / range : shown[shown.length - 1][0]
  const x = logScale(Math.min(least, 99), 100)
  const end = xAt(isPart ? x.at(least) : 0)
  const y = logScale(1, shown[shown.length - 1][1] * 1.2, kLeastLoops)
  let path = `M${xAt(x.at(shown[0][0]))} ${yAt(0)}`
  let before = ''
  for (const [percent, number] of shown) {
    const step = `H${xAt(x.at(percent)).toFixed(1)}V${yAt(y.at(number)).toFixed(1)}`
    if (step !== before) path += step // of a million loops most are at the same place
    before = step
  }
  path += `H${end.toFixed(1)}`
  // Left of the end of the curve: paper of another colour, with a text where there is room.
  const middle = (xAt(0) + end) / 2
  const unknown = isPart
    ? element('path', { class: 'unknown', d: `M${xAt(0)} ${yAt(0)}V${yAt(1)}H${end.toFixed(1)}V${yAt(0)}Z` }) +
      element('text', { class: 'quiet', transform: `translate(${(middle + 4).toFixed(1)} ${yAt(0.5)}) rotate(-90)`, 'text-anchor': 'middle' },
        end - xAt(0) > 16 ? 'not loaded' : '')
    : ''
  // They show nothing; they say what is under the pointer.
  const spots = shown
    .slice(0, 60)
    .map(([percent, number]) =>
      element('circle', { cx: xAt(x.at(percent)).toFixed(1), cy: yAt(y.at(number)).toFixed(1), r: 4, fill: 'transparent' },
        element('title', {}, `${count(number, 'loop')} of at least ${shortNumber(percent)} %`)),
    )
  const content =
    axes('Loops above a persistence', { title: 'persistence, % of the range', ticks: x.ticks }, { title: 'number of loops', ticks: y.ticks }) +
    unknown +
    element('path', { class: 'curve', d: path }) +
    spots.join('')
  const last = shown[shown.length - 1]
  const noise = isPart
    ? `Loops below ${shortNumber(Number(least.toPrecision(3)))} % of the range are not loaded, so the curve ends there; ${more}.`
    : 'A flat part is a gap: the loops left of it are noise or defects, those right of it are more likely features.'
  return figure(
    'plot-loops',
    content,
    '',
    `How many loops are at least as persistent as the value on the axis below; both axes are logarithmic. ${noise}`,
    `Loops above a persistence, both axes logarithmic: from 1 loop at ${shortNumber(shown[0][0])} per cent of the range to ${count(last[1], 'loop')} at ${shortNumber(last[0])} per cent.`,
  )
}

// `at` goes from 0 to 1.
export function niceTicks(least, most) {
  const step = (() => {
    const raw = (most - least) / 5
    const power = 10 ** Math.floor(Math.log10(raw))
    return power * [1, 2, 5, 10].find((factor) => factor * power >= raw * (1 - 1e-9))
  })()
  const values = []
  const first = Math.ceil(least / step - 1e-9)
  // Where the range is a few units in the last place, a step changes nothing: then there are fewer ticks, not endless ones.
  for (let k = 0, before = NaN; k <= 10 && (first + k) * step <= most + 1e-9 * step; ++k) {
    const value = (first + k) * step
    if (value !== before && value >= least - 1e-9 * step) values.push(value)
    before = value
  }
  const texts = distinctNumbers(values)
  return values.map((value, i) => ({ at: (value - least) / (most - least), value, text: texts[i] }))
}

const kMostTickLetters = 7

const kTypes = [
  ['Ord0', 'minima', 'M-4-3H4L0 4Z'],
  ['Rel1', 'maxima', 'M-4 3H4L0-4Z'],
  ['Ext1', 'loops', 'M-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0Z'],
  ['Ext0', 'components', 'M-4-4H4V4H-4Z'],
]

// `pairs`: [type, lower value, upper value, ...], of `total` pairs those of largest persistence. The first coordinate is
// where a feature begins, as in docs/SEMANTICS.md: the lower value of a minimum or a component, the upper value of a
// maximum or a loop, so these are below the diagonal.
export function persistenceDiagram(pairs, min, max, total) {
  if (pairs.length === 0 || !(max > min)) return null
  const nice = niceTicks(min, max)
  const digits = digitsFor(min, max)
  // Where the range is small beside the values, differences fit beside the axis.
  const isLong = nice.length > 1 && nice.some(({ text }) => text.length > kMostTickLetters)
  const step = isLong ? nice[1].value - nice[0].value : 1
  const unit = step < 1e-3 || step >= 1e6 ? 10 ** Math.floor(Math.log10(step)) : 1
  const difference = (value) => String(Number(((value - nice[0].value) / unit).toPrecision(3)))
  const ticks = nice.map(({ at, value, text }) => ({ at: 0.02 + 0.96 * at, text: isLong ? difference(value) : text }))
  const less = isLong ? `, less ${nice[0].text}${unit === 1 ? '' : `, in ${unit.toPrecision(1)}`}` : ''
  const part = (value) => 0.02 + (0.96 * (value - min)) / (max - min)
  const legend = kTypes.map(([type, name, shape]) =>
    `<span><svg viewBox="-6 -6 12 12" aria-hidden="true"><path class="${type}" d="${shape}"/></svg> ${name} (${type})</span>`)
  const marks = [...pairs].reverse().map(([type, low, high, lowVertex, highVertex]) => {
    const shape = kTypes.find(([name]) => name === type)[2]
    const [begin, end] = type === 'Ord0' || type === 'Ext0' ? [low, high] : [high, low]
    const title = `${type}: vertex ${lowVertex} (${shortNumber(low, digits)}) to ${highVertex} (${shortNumber(high, digits)}), persistence ${shortNumber(high - low)}`
    return `<path class="${type}" d="${shape}" transform="translate(${xAt(part(begin)).toFixed(1)} ${yAt(part(end)).toFixed(1)})"><title>${title}</title></path>`
  })
  const content =
    axes('Persistence diagram', { title: `value where the feature begins${less}`, ticks }, { title: `value where it ends${less}`, ticks }) +
    element('path', { class: 'diagonal', d: `M${xAt(0)} ${yAt(0)}L${xAt(1)} ${yAt(1)}` }) +
    marks.join('')
  const some = pairs.length < total ? ` The ${count(pairs.length, 'pair')} of largest persistence are drawn, of ${total.toLocaleString('en')}.` : ''
  return figure(
    'plot-diagram',
    content,
    `<div class="legend">${legend.join('')}</div>`,
    `Each mark is a pair of nodes: what begins at one and ends at the other; minima and components above the dashed diagonal, maxima and loops below. The further from it, the larger the feature.${some}`,
    `Persistence diagram of ${count(pairs.length, 'pair')}; the list of features has the same values.`,
  )
}

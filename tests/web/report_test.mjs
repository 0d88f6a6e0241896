// What the page of `reeb report` does in a browser: no complaints, tables that sort, a slider that draws the arcs that
// `reeb extract` writes, pictures that are not empty.
//
//   node report_test.mjs REEB FOLDER     FOLDER has scan.reeb and the pages scan, terrain, empty, point, flat, bare and parts.html
import { execFileSync } from 'node:child_process'
import { readFileSync, writeFileSync } from 'node:fs'
import { join } from 'node:path'
import { Browser, kColors, kPixels, pause } from './browser.mjs'

const [reeb, folder] = process.argv.slice(2)
let failures = 0

function check(what, good, seen = '') {
  if (good) return console.log(`ok: ${what}`)
  console.log(`FAILED: ${what}: ${typeof seen === 'string' ? seen : JSON.stringify(seen)}`)
  ++failures
}

const same = (what, seen, wanted) =>
  check(what, JSON.stringify(seen) === JSON.stringify(wanted), `${JSON.stringify(seen)} instead of ${JSON.stringify(wanted)}`)

function extracted(threshold) {
  const text = execFileSync(reeb, ['extract', join(folder, 'scan.reeb'), '--threshold', threshold], { encoding: 'utf8' })
  const count = (letter) => text.split('\n').filter((line) => line.startsWith(`${letter} `)).length
  return { nodes: count('n'), arcs: count('a') }
}

const kDrawn = `new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => {
  const { nodes, arcs, loops, threshold } = document.getElementById('drawn').dataset
  done({ nodes: Number(nodes), arcs: Number(arcs), loops: Number(loops), threshold: Number(threshold) })
})))`

function unasked(browser, page) {
  same(`${page}: no complaint in the console`, browser.complaints(), [])
  same(`${page}: nothing asked of the network`, browser.requests(), [])
}

// Its text, what is said of it, and whether that can be seen.
const thresholdBox = (browser) => browser.evaluate(`(() => {
  const input = document.getElementById('threshold')
  const note = document.getElementById(input.getAttribute('aria-describedby'))
  return [input.value, note.textContent, note.getBoundingClientRect().height > 10 && note.getBoundingClientRect().width > 10]
})()`)

async function slider(browser) {
  const last = await browser.evaluate(`Number(document.getElementById('level').max)`)
  check('there are levels', last > 20, last)
  for (const level of [0, 1, Math.floor(last / 3), Math.floor(last / 2), last - 1, last]) {
    const drawn = await browser.evaluate(`(() => {
      const slider = document.getElementById('level')
      slider.value = ${level}
      slider.dispatchEvent(new Event('input'))
      return ${kDrawn}
    })()`)
    const { nodes, arcs } = extracted(String(drawn.threshold))
    same(`level ${level} has the nodes and arcs of extract`, [drawn.nodes, drawn.arcs], [nodes, arcs])
    const [shown] = await thresholdBox(browser)
    same(`level ${level} is that of its number, ${shown}`, extracted(shown), { nodes, arcs })
  }
  for (const threshold of ['0', '0.5%', '2%', '0.01', '1e9']) {
    const drawn = await browser.evaluate(`(() => {
      const input = document.getElementById('threshold')
      input.value = '${threshold}'
      input.dispatchEvent(new Event('change'))
      return ${kDrawn}
    })()`)
    const { nodes, arcs } = extracted(threshold)
    same(`threshold ${threshold} has the nodes and arcs of extract`, [drawn.nodes, drawn.arcs], [nodes, arcs])
    const [text, note] = await thresholdBox(browser)
    same(`threshold ${threshold} stays as it was typed`, text, threshold)
    const level = /^level (.+)$/.exec(note)?.[1] ?? threshold
    check('the level is said beside', Math.abs(Number(level) - drawn.threshold) <= 1e-5 * drawn.threshold, [note, drawn])
  }
  for (const wrong of ['abc', '-3', '']) {
    await browser.evaluate(`(() => {
      const input = document.getElementById('threshold')
      input.value = '${wrong}'
      input.dispatchEvent(new Event('change'))
    })()`)
    const [text, note, isSeen] = await thresholdBox(browser)
    check(`"${wrong}" is refused where it was typed`, text === wrong && /^This is not a threshold/.test(note) && isSeen, [text, note, isSeen])
  }
  await browser.evaluate(`(() => { const level = document.getElementById('level'); level.value = 0; level.focus() })()`)
  await browser.press('ArrowRight')
  same('the arrow keys move the slider', await browser.evaluate(`document.getElementById('level').value`), '1')
  check(
    'what the slider says to a screen reader',
    /per cent of the range: [\d,]+ nodes?, [\d,]+ arcs?, [\d,]+ loops?/.test(
      await browser.evaluate(`document.getElementById('level').getAttribute('aria-valuetext')`),
    ),
  )
  const before = await browser.evaluate(`document.querySelector('#canvas-place canvas').toDataURL()`)
  await browser.evaluate(`document.getElementById('canvas-place').focus()`)
  await browser.press('ArrowLeft')
  let after = before
  for (let i = 0; i < 40 && after === before; ++i) {
    await pause(50)
    after = await browser.evaluate(`document.querySelector('#canvas-place canvas').toDataURL()`)
  }
  check('the arrow keys rotate the skeleton', before !== after)
}

async function tables(browser) {
  const column = (table, index) =>
    `[...document.querySelector('${table} tbody').rows].map((row) => row.cells[${index}].dataset.value ?? row.cells[${index}].textContent)`
  for (const [section, name] of [['#features', 'persistence'], ['#features', 'rank'], ['#defects', 'kind'], ['#defects', 'centre'], ['#levels', 'nodes']]) {
    const index = await browser.evaluate(
      `[...document.querySelector('${section} thead').rows[0].cells].findIndex((cell) => cell.textContent === '${name}')`,
    )
    const before = await browser.evaluate(column(section, index))
    const press = `[...document.querySelectorAll('${section} thead button')].find((b) => b.textContent === '${name}').click()`
    const orders = {}
    for (let i = 0; i < 2; ++i) {
      await browser.evaluate(press)
      const sort = await browser.evaluate(
        `document.querySelector('${section} thead').rows[0].cells[${index}].getAttribute('aria-sort')`,
      )
      orders[sort] = await browser.evaluate(column(section, index))
    }
    const numeric = before.every((text) => !Number.isNaN(Number(text)))
    const byPlace = (a, b) => a.split(', ').reduce((order, x, i) => order || x - b.split(', ')[i], 0)
    const sorted = [...before].sort(name === 'centre' ? byPlace : numeric ? (a, b) => a - b : (a, b) => a.localeCompare(b))
    same(`${section} sorts by ${name}, ascending`, orders.ascending?.map(String), sorted)
    same(`${section} sorts by ${name}, descending`, orders.descending?.map(String), [...sorted].reverse())
  }
}

async function structure(browser, what) {
  const seen = await browser.evaluate(`({
    headings: [...document.querySelectorAll('h2')].map((h) => h.textContent),
    titles: [...document.querySelectorAll('.plot .title')].map((t) => t.textContent),
    steps: document.querySelector('.plot .curve').getTotalLength() > 100,
    marks: document.querySelectorAll('#plot-diagram title').length,
    closeups: [...document.querySelectorAll('.closeup canvas')].map(${kColors}),
    wide: document.documentElement.scrollWidth - innerWidth,
    unnamed: [...document.querySelectorAll('button, input, canvas')].filter((element) => !(element.textContent ||
      element.getAttribute('aria-label') || element.labels?.length || element.closest('[aria-label]'))).length,
  })`)
  same(`${what}: headings`, seen.headings, ['Summary', 'Skeleton', 'Plots', 'Features', 'Defects', 'Levels'])
  same(`${what}: titles of plots`, seen.titles, ['Loops above a persistence', 'Persistence diagram'])
  check(`${what}: the curve of loops`, seen.steps)
  check(`${what}: marks in the diagram`, seen.marks > 20, seen.marks)
  check(`${what}: close-ups are painted`, seen.closeups.length > 0 && seen.closeups.every((n) => n > 20), seen.closeups)
  check(`${what}: as wide as the window`, seen.wide <= 0, seen.wide)
  same(`${what}: everything has a name`, seen.unnamed, 0)
}

// Captions have the numbers of `reeb defects`.
async function closeups(browser) {
  const output = join(folder, 'defects.json')
  execFileSync(reeb, ['defects', join(folder, 'scan.ply'), join(folder, 'scan.reeb'), '-o', output, '--quiet', '--force'])
  const { loops } = JSON.parse(readFileSync(output, 'utf8'))
  const captions = await browser.evaluate(`[...document.querySelectorAll('.closeup figcaption .quiet')].map((text) => text.textContent)`)
  check('there are close-ups', captions.length === Math.min(12, loops.length), captions)
  captions.forEach((caption, i) => {
    const loop = loops[i]
    const wanted = [Math.min(...[loop.length_contour, loop.length_cycle].filter((x) => x !== 'inf')), loop.center_x, loop.center_y, loop.center_z]
    const seen = /^curve (\S+) long at (\S+), (\S+), (\S+); picture \S+ wide/.exec(caption)?.slice(1).map(Number) ?? []
    check(`the caption of close-up ${i} has length and place`, wanted.every((x, k) => Math.abs(seen[k] - x) <= 0.005 * Math.abs(x)), [caption, wanted])
  })
}

// A curve that is a 500th as large: a dot, which stays where it is while the picture rotates and grows, until the curve
// itself is seen.
async function tinyCurve(browser) {
  const page = readFileSync(join(folder, 'scan.html'), 'utf8')
  const [, json] = /id="data">([^]*?)<\/script>/.exec(page)
  const data = JSON.parse(json)
  const [closeup] = data.closeups
  const places = Buffer.from(closeup.places, 'base64')
  for (const v of closeup.curve)
    for (let k = 0; k < 3; ++k) {
      const center = ((closeup.center[k] - closeup.min[k]) / closeup.size) * 65535
      const at = 8 * v + 2 * k
      places.writeUInt16LE(Math.round(center + (places.readUInt16LE(at) - center) / 500), at)
    }
  closeup.places = places.toString('base64')
  closeup.other = []
  writeFileSync(join(folder, 'tiny.html'), page.replace(json, () => JSON.stringify(data).replaceAll('<', '\\u003c')))
  await browser.open(`file://${join(folder, 'tiny.html')}`)
  const press = (key, times) => browser.evaluate(`new Promise((done) => {
    const canvas = document.querySelector('#closeup-0 canvas')
    for (let i = 0; i < ${times}; ++i) canvas.dispatchEvent(new KeyboardEvent('keydown', { key: '${key}' }))
    requestAnimationFrame(() => requestAnimationFrame(() => done()))
  })`)
  const middle = () => browser.evaluate(`(({ width, height }, pixels) => {
    const at = 4 * (Math.floor(height / 2) * width + Math.floor(width / 2))
    return [...pixels.slice(at, at + 3)].join()
  })(document.querySelector('#closeup-0 canvas'), (${kPixels})(document.querySelector('#closeup-0 canvas')))`)
  const kDot = '213,94,0' // --max
  same('a curve that is too small to see is a dot', await middle(), kDot)
  await press('ArrowLeft', 5)
  await press('ArrowUp', 3)
  await press('+', 8)
  same('which stays when the picture rotates and grows', await middle(), kDot)
  await press('+', 40)
  check('the curve is seen in the end', (await middle()) !== kDot, await middle())
}

// The browser's dark colours are not for paper.
async function paper(browser) {
  await browser.open(`file://${join(folder, 'scan.html')}`, { dark: true })
  const seen = await browser.evaluate(`new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => {
    const closeup = () => document.querySelector('.closeup canvas').toDataURL()
    const dark = closeup()
    dispatchEvent(new Event('beforeprint'))
    const rims = [...new Set([...document.querySelectorAll('#canvas-place svg path[transform]')].map((mark) => mark.getAttribute('stroke')))]
    const printed = closeup()
    dispatchEvent(new Event('afterprint'))
    done({ rims, light: printed !== dark, again: closeup() === dark, paper: getComputedStyle(document.body).backgroundColor })
  })))`)
  same('a dark page is printed in light colours', [seen.rims, seen.light], [['#222222'], true])
  same('and is dark again', [seen.again, seen.paper], [true, 'rgb(20, 23, 27)'])
}

// As in docs/SEMANTICS.md: minima and components lie above the diagonal, maxima and loops below.
async function diagram(browser) {
  const seen = await browser.evaluate(`(() => {
    const points = document.querySelector('#plot-diagram .diagonal').getAttribute('d').match(/[\\d.]+/g).map(Number)
    const [left, bottom, right, top] = points
    const of = (type) => [...document.querySelectorAll('#plot-diagram .plot path.' + type)].map((mark) => {
      const [x, y] = mark.getAttribute('transform').match(/[\\d.]+/g).map(Number)
      return (bottom - y) / (bottom - top) - (x - left) / (right - left)
    })
    return { above: [...of('Ord0'), ...of('Ext0')], below: [...of('Rel1'), ...of('Ext1')] }
  })()`)
  check('minima and components are above the diagonal', seen.above.length > 1 && seen.above.every((d) => d > -0.01) && seen.above.some((d) => d > 0.1), seen)
  check('maxima and loops are below it', seen.below.length > 1 && seen.below.every((d) => d < 0.01) && seen.below.some((d) => d < -0.1), seen)
}

// The curve of loops ends on the axis, which begins below 1.
async function lastDrop(browser) {
  const [first, second] = await browser.evaluate(`document.querySelector('#plot-loops .curve').getAttribute('d').match(/M[^ ]+ ([\\d.]+)H[\\d.]+V([\\d.]+)/).slice(1).map(Number)`)
  check('the curve of loops has its last drop', first - second > 5, [first, second])
}

// Moves the pointer to a place that is drawn, near the middle of the skeleton, until something is said of it. The page
// may still be scrolling, and a frame may take long where a processor draws it: the place is sought each time.
async function hover(browser) {
  for (let i = 0; i < 40; ++i) {
    const [x, y] = await browser.evaluate(`(() => {
      const place = document.getElementById('canvas-place')
      place.scrollIntoView({ behavior: 'instant' })
      const drawn = place.querySelector('canvas')
      const canvas = document.createElement('canvas')
      canvas.width = drawn.width
      canvas.height = drawn.height
      const context = canvas.getContext('2d')
      context.drawImage(drawn, 0, 0)
      const { data } = context.getImageData(0, 0, canvas.width, canvas.height)
      let best = { distance: Infinity, x: 0, y: 0 }
      for (let y = 0; y < canvas.height; ++y)
        for (let x = 0; x < canvas.width; ++x) {
          const distance = Math.hypot(x - canvas.width / 2, y - canvas.height / 2)
          if (data[4 * (y * canvas.width + x) + 3] > 200 && distance < best.distance) best = { distance, x, y }
        }
      const { left, top } = place.getBoundingClientRect()
      return [left + (best.x / canvas.width) * place.clientWidth, top + (best.y / canvas.height) * place.clientHeight]
    })()`)
    await browser.send('Input.dispatchMouseEvent', { type: 'mouseMoved', x: x + (i % 2), y })
    await pause(50 + 10 * i)
    const text = await browser.evaluate(`(({ hidden, textContent }) => (hidden ? '' : textContent))(document.getElementById('tooltip'))`)
    if (/vertex \d+/.test(text)) return true
  }
  return false
}

async function withWebgl() {
  const browser = await Browser.start({ switches: ['--enable-unsafe-swiftshader'] })
  const url = (name) => `file://${join(folder, name)}`
  await browser.open(url('scan.html'))
  const colors = await browser.evaluate(`(${kColors})(document.querySelector('#canvas-place canvas'))`)
  check('the skeleton is drawn', colors > 20, colors)
  await structure(browser, 'wide')
  await diagram(browser)
  await lastDrop(browser)
  await closeups(browser)
  await slider(browser)
  await tables(browser)
  await browser.evaluate(`document.querySelector('[data-pair="1"]').click()`)
  check('a feature is announced', /is marked in the skeleton/.test(await browser.evaluate(`document.getElementById('announcement').textContent`)))
  await browser.evaluate(`document.querySelector('[data-closeup="0"]').click()`)
  same('a close-up is chosen', await browser.evaluate(`document.activeElement.closest('figure').id`), 'closeup-0')
  check('hovering says what is there', await hover(browser))
  await browser.send('Emulation.setEmulatedMedia', { media: 'print' })
  const printed = await browser.evaluate(`[...document.querySelectorAll('.scroll table')].map((table) => {
    const shown = (row) => [...row.cells].filter((cell) => getComputedStyle(cell).display !== 'none').length
    const columns = shown(table.tHead.rows[0])
    return [columns, [...table.tBodies[0].rows].every((row) => shown(row) === columns)]
  })`)
  check('on paper all rows have the columns of the heading', printed.every(([columns, same]) => columns > 4 && same), printed)
  await browser.send('Emulation.setEmulatedMedia', { media: '' })
  check('it prints', (await browser.pdf()).length > 20000)
  unasked(browser, 'scan.html')

  await browser.open(url('scan.html'), { width: 1200 })
  same('tables fit into 1,200 pixels', await browser.evaluate(`[...document.querySelectorAll('section > .scroll')].filter((e) => e.scrollWidth > e.clientWidth).length`), 0)
  await browser.open(url('terrain.html'), { width: 1200 })
  check('one plot alone is not larger', (await browser.evaluate(`document.querySelector('.plot').clientWidth`)) <= 640)

  await browser.open(url('scan.html'), { width: 1200, scale: 2 })
  await browser.resize({ width: 900, height: 900, scale: 1 })
  const sharp = `(({ width, clientWidth }) => width === clientWidth)(document.querySelector('#canvas-place canvas'))`
  let isSharp = false
  for (let i = 0; i < 40 && !isSharp; ++i) {
    await pause(50)
    isSharp = await browser.evaluate(sharp)
  }
  check('a page that is zoomed has pictures of its pixels', isSharp)
  await browser.open(url('scan.html'), { width: 360, dark: true })
  await structure(browser, 'narrow and dark')
  same('dark paper', await browser.evaluate(`getComputedStyle(document.body).backgroundColor`), 'rgb(20, 23, 27)')
  unasked(browser, 'narrow')
  for (const [page, message] of [['empty.html', 'The graph is empty'], ['point.html', ''], ['bare.html', ''], ['flat.html', '']]) {
    await browser.open(url(page))
    const seen = await browser.evaluate(`(({ hidden, textContent }) => (hidden ? '' : textContent))(document.getElementById('skeleton-message'))`)
    check(`${page}: says what there is`, message === '' ? seen === '' : seen.startsWith(message), seen)
    unasked(browser, page)
  }
  await tinyCurve(browser)
  unasked(browser, 'tiny.html')
  await paper(browser)
  await browser.open(url('flat.html'))
  const ticks = await browser.evaluate(`[...document.querySelectorAll('#plot-diagram text[text-anchor=end]')].map((text) => text.textContent)`)
  check('ticks of values that hardly differ are told apart', ticks.length > 1 && new Set(ticks).size === ticks.length, ticks)
  await browser.open(url('parts.html'))
  same('many components leave the first level its features', (await browser.evaluate(kDrawn)).nodes, 361)
  same('a point is one node', await (async () => {
    await browser.open(url('point.html'))
    return (await browser.evaluate(kDrawn)).nodes
  })(), 1)
  await browser.stop()
}

async function withoutWebgl() {
  const browser = await Browser.start({ switches: ['--disable-gpu', '--disable-3d-apis'] })
  await browser.open(`file://${join(folder, 'scan.html')}`)
  const seen = await browser.evaluate(`({
    message: document.getElementById('skeleton-message').textContent,
    lines: document.querySelectorAll('#canvas-place svg path').length,
  })`)
  check('without WebGL: a message', seen.message.startsWith('This browser has no WebGL'), seen.message)
  check('without WebGL: lines', seen.lines > 50, seen.lines)
  await sliderWithoutWebgl(browser)
  await browser.open(`file://${join(folder, 'parts.html')}`)
  const marks = await browser.evaluate(`[...document.querySelectorAll('#canvas-place svg path[transform]')].map((mark) => /scale\\(0/.test(mark.getAttribute('transform')))`)
  const small = marks.filter(Boolean).length
  check('marks of tiny components are small, those of long arcs are not', marks.length === 361 && small >= 300 && small < 330, [marks.length, small])
  await browser.stop()
}

async function sliderWithoutWebgl(browser) {
  const count = () => browser.evaluate(`new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() =>
    done(document.querySelectorAll('#canvas-place svg path').length))))`)
  const before = await count()
  await browser.evaluate(`(() => { const slider = document.getElementById('level'); slider.value = slider.max; slider.dispatchEvent(new Event('input')) })()`)
  check('without WebGL: the slider works', (await count()) < before)
}

await withWebgl()
await withoutWebgl()
process.exit(failures > 0 ? 1 : 0)

// The viewer's page: connects sources, reader, pictures, plots and controls.
import { Camera, control } from '../web/camera.js'
import { onThemeChange } from '../web/colors.js'
import { count, shortNumber } from '../web/data.js'
import { loopsPlot, niceTicks, persistenceDiagram } from '../web/plots.js'
import { makeTable } from '../web/table.js'
import { backdropBytes, placed, readBackdrop } from './backdrop'
import type { Backdrop } from './backdrop'
import { FormatError } from './bytes'
import { FlatCamera } from './flat_camera'
import type { VersionContent } from './loaded_graph'
import { kColorings, kKinds, kNoArc, Picture } from './picture'
import type { Coloring, Found } from './picture'
import { Session } from './session'
import { flatShape, frameOf, shapeBytes, skeletonShape } from './shapes'
import type { Frame, Shape } from './shapes'
import { atOnce, inSlices } from './slices'
import { BlobSource, HttpSource, SourceError } from './source'
import type { Source } from './source'
import { readState, writeState } from './url_state'

const kDefaultBudget = 200_000
const kLegibleNodes = 200 // of the level that is shown first, beside those of the coarsest level
const kMostMarks = 1000
const kLayoutMilliseconds = 200 // after the last move of the slider
const kCountMilliseconds = 100 // between two texts about what was read
const kTypes = ['Ext0', 'Ext1', 'Ord0', 'Rel1']

const element = <T extends HTMLElement>(id: string) => document.getElementById(id) as T
const slider = element<HTMLInputElement>('level')
const input = element<HTMLInputElement>('threshold')
const budgetInput = element<HTMLInputElement>('budget')
const coloringInput = element<HTMLSelectElement>('coloring')
const drawn = element('drawn')
const tooltip = element('tooltip')
const announce = (text: string) => (element('announcement').textContent = text)

// A feature: one node, an arc, or a pair.
interface Choice {
  arc: number
  nodes: number[]
  text: string
}
type Mark = [string, number, number, number, number] // type, values, vertices
interface View {
  place: HTMLElement
  picture: Picture
  camera: Camera
}

let session: Session | null = null
let content: VersionContent | null = null
let box: Frame | null = null
let shapeRecords = -1 // of the pictures, also while they are being made
let drawnRecords = -1 // of the pictures that are there
let spaceBytes = 0
let flatBytes = 0
let marks: { mark: Mark; lo: number; hi: number }[] = []
let choice: Choice | null = null
let space: View | null = null
let flat: View | null = null
let backdrop: Backdrop | null = null
let layoutTimer = 0
let stopShapes = () => {}
let pairsAt = -1
let opened = performance.now()

function say(error: unknown, again: (() => void) | null = null) {
  const message = element('message')
  message.hidden = error === null
  if (error === null) return
  if (error instanceof DOMException && error.name === 'AbortError') return void (message.hidden = true)
  const text = error instanceof FormatError ? `${capital(error.message)}.` : ((error as Error).message ?? String(error))
  message.textContent = error instanceof SourceError ? `${text}\n${error.hint}` : text
  if (!again) return
  const button = document.createElement('button')
  button.textContent = 'Try again'
  button.addEventListener('click', again)
  message.append('\n', button)
}

const capital = (text: string) => text[0].toUpperCase() + text.slice(1)
const bytesText = (bytes: number) =>
  bytes < 2 ** 20 ? `${(bytes / 2 ** 10).toFixed(1)} KiB` : `${(bytes / 2 ** 20).toFixed(1)} MiB`
const range = () => session!.reader.header.max - session!.reader.header.min

// The slider is logarithmic: 0 is the threshold 0, its end the whole range.
function decades(): number {
  const least = session!.reader.header.levels.map(({ threshold }) => threshold).filter((t) => t > 0).pop()
  if (!least || !(range() > 0)) return 3
  return Math.min(14, Math.max(1, Math.log10(range() / least) + 0.3))
}
const thresholdAt = (at: number) => (at <= 0 ? 0 : range() * 10 ** (-decades() * (1 - at / 1000)))
const placeOf = (threshold: number) =>
  threshold > 0 && range() > 0 ? Math.max(1, Math.min(1000, 1000 * (1 + Math.log10(threshold / range()) / decades()))) : 0

async function open(source: Source) {
  session?.close()
  stopShapes()
  session = null
  content = box = choice = backdrop = null
  showBackdrop()
  shapeRecords = drawnRecords = pairsAt = -1
  marks = []
  element('figures').replaceChildren()
  element('plots-message').textContent = element('chosen').textContent = ''
  element('view').hidden = true
  element('name').textContent = source.name
  element('subtitle').textContent = 'Loading ...'
  document.title = `${source.name} - reeb viewer`
  say(null)
  opened = performance.now()
  const again = () => void (source instanceof HttpSource ? openUrl(element<HTMLInputElement>('url').value) : open(source))
  try {
    const state = readState()
    const opening = Session.open(source, state.budget ?? kDefaultBudget)
    opening.catch(() => {}) // is waited for below
    makeViews()
    const made = await opening
    session = made
    const { header } = made.reader
    element('subtitle').textContent =
      `${header.name} from ${shortNumber(header.min)} to ${shortNumber(header.max)}; full graph: ${count(header.nodes, 'node')}, ` +
      `${count(header.arcs, 'arc')}, ${count(header.components, 'component')}, ${count(header.loops, 'loop')}`
    budgetInput.value = String(made.budget)
    element('scale-min').textContent = shortNumber(header.min)
    element('scale-max').textContent = shortNumber(header.max)
    element<HTMLDetailsElement>('open').open = false
    const coarsest = header.levels[0]! // its nodes are in all levels
    const legible = header.levels.filter(({ nodes }) => nodes <= coarsest.nodes + kLegibleNodes).pop()!
    // First what one frame has, whatever it is.
    made.wanted = Infinity
    await made.want(Infinity, () => {})
    performance.mark('reeb-bytes')
    if (session !== made) return
    if (made.reader.graph.finest > header.steps) {
      if (made.reader.damage) throw made.reader.damage
      throw new FormatError('the file has no complete version', made.source.size)
    }
    element('view').hidden = false
    space?.camera.setUp(upOf(header.name))
    coloringInput.value = state.coloring ?? 'value'
    setColoring()
    refresh(state.threshold ?? legible.threshold)
    fit()
    if (state.camera && space) Object.assign(space.camera, state.camera)
    await picture()
    performance.mark('reeb-picture')
    drawn.dataset.first = String(Math.round(performance.now() - opened))
    if (session !== made) return
    showLevels()
    setThreshold(state.threshold ?? legible.threshold)
    await readPairs()
    if (state.chosen) chooseVertices(state.chosen)
  } catch (error) {
    if (source === session?.source || session === null) say(error, again)
    if (session === null) element('subtitle').textContent = 'This file could not be opened.'
  }
}

async function readPairs() {
  const current = session!
  const { reader } = current
  if (pairsAt === reader.graph.nodes) return
  const nodes = reader.graph.nodes
  try {
    const pairs = await reader.readPairs()
    if (session !== current) return
    current.pairs = pairs
    pairsAt = nodes
    showPlots()
  } catch (error) {
    if (session !== current) return
    current.pairs = null
    element('plots-message').textContent = `There are no plots: ${(error as Error).message}.`
    if (!(error instanceof DOMException)) say(error)
  }
}

function makeViews() {
  if (space) return
  const view = (id: string, camera: Camera): View => {
    const place = element(id)
    const picture = new Picture(place)
    const made = { place, picture, camera }
    control(place, camera, {
      changed: () => redraw(),
      hovered: (at: number[] | null) => hover(made, at),
      reset: () => fit(),
    })
    let down = [0, 0]
    place.addEventListener('pointerdown', (event) => (down = [event.clientX, event.clientY]))
    place.addEventListener('pointerup', (event) => {
      if (Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 5) choose(found(made, placeIn(made, event)))
    })
    new ResizeObserver(() => redraw()).observe(place)
    return made
  }
  try {
    space = view('space', new Camera())
    flat = view('flat', new FlatCamera())
  } catch {
    space = flat = null
    say(new Error('This browser has no WebGL, so there are no pictures of the graph. Plots and levels work.'))
  }
}

// The axis that points upwards.
const upOf = (name: string) => (['x', 'y', 'z'].includes(name) ? ['x', 'y', 'z'].indexOf(name) : 2)

const views = () => [space, flat].filter((view) => view !== null)

const placeIn = ({ place }: View, event: PointerEvent) => {
  const corner = place.getBoundingClientRect()
  return [event.clientX - corner.left, event.clientY - corner.top]
}

// Shows the version of the wanted threshold, as far as it was read.
function refresh(wanted = session!.wanted) {
  const { reader } = session!
  const { graph, header } = reader
  if (graph.finest > header.steps) return
  const version = graph.versionAt(wanted)
  const grown = graph.records !== shapeRecords
  if (!grown && content?.version === version) return showCounts()
  try {
    content = graph.contentOf(version)
  } catch (error) {
    return say(error)
  }
  if (!grown) {
    clearTimeout(layoutTimer)
    layoutTimer = window.setTimeout(layout, kLayoutMilliseconds)
    return showContent()
  }
  const isFirst = shapeRecords < 0
  shapeRecords = graph.records
  box ??= frameOf(graph)
  if (!space || !flat) return showContent()
  stopShapes()
  if (isFirst) {
    showShapes(atOnce(shapesOf(content)))
    return showContent()
  }
  // The pictures stay as they are until those of more arcs are made.
  stopShapes = inSlices(shapesOf(content), (shapes) => {
    showShapes(shapes)
    refresh()
    showContent()
  })
  showCounts()
}

interface Shapes {
  space: Shape | null
  flat: Shape
}

function* shapesOf(shown: VersionContent): Generator<void, Shapes> {
  const { graph, header } = session!.reader
  const finest = shown.version === graph.finestOffered ? shown : graph.contentOf(graph.finestOffered)
  return {
    space: header.positions ? yield* skeletonShape(graph, box!) : null,
    flat: yield* flatShape(graph, shown, finest),
  }
}

function showShapes(shapes: Shapes) {
  drawnRecords = shapeRecords
  if (shapes.space) {
    spaceBytes = shapeBytes(shapes.space)
    space!.picture.setShape(shapes.space)
  }
  showFlat(shapes.flat)
}

function showFlat(shape: Shape) {
  flatBytes = shapeBytes(shape)
  flat!.picture.setShape(shape)
}

// The nodes of the version that is shown spread over the whole picture.
function layout() {
  if (!flat || !content || !session) return
  const { graph } = session.reader
  if (drawnRecords !== shapeRecords) return // others are being made
  const finest = content.version === graph.finestOffered ? content : graph.contentOf(graph.finestOffered)
  stopShapes()
  stopShapes = inSlices(flatShape(graph, content, finest), (shape) => {
    showFlat(shape)
    showContent()
  })
}

// As in kKinds.
function kindOf({ up, down, isIn }: VersionContent, node: number): number {
  if (up[node] + down[node] === 0) return isIn(node) ? 4 : 0
  return down[node] === 0 ? 1 : up[node] === 0 ? 2 : 3
}

function kindsOf(version: VersionContent): Uint8Array {
  const kinds = new Uint8Array(version.up.length)
  for (let i = 0; i < kinds.length; ++i) kinds[i] = kindOf(version, i)
  return kinds
}

// An arc has the kind of its end: a minimum, a maximum, between saddles, or both.
function typesOf(kinds: Uint8Array): Uint8Array {
  const { graph } = session!.reader
  const types = new Uint8Array(graph.records)
  for (let i = 0; i < types.length; ++i) {
    const [isMin, isMax] = [kinds[graph.lo[i]] === 1, kinds[graph.hi[i]] === 2]
    types[i] = isMin ? (isMax ? 4 : 1) : isMax ? 2 : 3
  }
  return types
}

function showContent() {
  if (!content) return
  const kinds = kindsOf(content)
  const types = coloringInput.value === 'type' ? typesOf(kinds) : null
  for (const { picture } of views()) picture.show(content.version, kinds, types)
  for (const view of views()) view.picture.choose(choice?.arc ?? kNoArc, choice?.nodes.filter(content.isIn) ?? [])
  showCounts()
  const threshold = thresholdOf(content.version)
  for (const mark of document.querySelectorAll<SVGElement>('[data-mark]')) {
    const [, low, high] = marks[Number(mark.dataset.mark)].mark
    mark.classList.toggle('below', high - low < threshold)
  }
  redraw()
}

function thresholdOf(version: number): number {
  const line = session!.reader.header.levels.find((level) => level.version === version)
  if (line) return line.threshold
  return version === 0 ? 0 : session!.reader.graph.persistenceOf(version)
}

function showCounts() {
  const { reader, source, end, isReading, budget } = session!
  const { graph, header } = reader
  // Cancelling keeps components.
  const loops = content!.arcs - content!.nodes + header.components
  const texts = [count(content!.nodes, 'node'), count(content!.arcs, 'arc'), count(loops, 'loop')].join(', ')
  const threshold = thresholdOf(content!.version)
  const percent = range() > 0 ? (100 * threshold) / range() : 0
  drawn.textContent =
    content!.version === 0 ? `The full graph: ${texts}.` : `Features below ${Number(percent.toPrecision(3))} % of the range are removed: ${texts}.`
  Object.assign(drawn.dataset, {
    nodes: content!.nodes, arcs: content!.arcs, loops, version: content!.version, finest: graph.finest,
    records: graph.records, loaded: source.loaded, memory: graph.memoryBytes, reading: isReading,
  })
  slider.setAttribute('aria-valuetext', `${Number(percent.toPrecision(3))} per cent of the range: ${texts}`)
  for (const { place } of views()) place.setAttribute('aria-label', `${place.id === 'space' ? 'The skeleton in space' : 'The graph by value'}: ${texts}`)
  const memory = graph.memoryBytes + spaceBytes + flatBytes + (backdrop ? backdropBytes(backdrop) : 0)
  let text =
    `${bytesText(Math.min(source.loaded, source.size))} read, of a file of ${bytesText(source.size)}; ${graph.records.toLocaleString('en')} of ` +
    `${header.records.toLocaleString('en')} arc records, at most ${budget.toLocaleString('en')}; ${bytesText(memory)} of memory.`
  if (isReading) text += ' Loading finer levels ...'
  else if (end === 'budget') text += ' The budget is reached: this is the finest level within it.'
  else if (end === 'damage') text += ` No finer level can be read: ${reader.damage!.message}.`
  element('loaded').textContent = text
  element('stop').hidden = !isReading
}

function setThreshold(threshold: number) {
  const current = session!
  slider.value = String(placeOf(threshold))
  input.value = threshold > 0 && threshold < 1e-300 ? 'above 0' : shortNumber(threshold)
  input.removeAttribute('aria-invalid')
  let shown = 0
  const step = () => {
    if (session !== current) return
    // Pictures are made again when there is twice as much to see, not after each frame of the file.
    if (current.reader.graph.records >= 2 * shapeRecords) return refresh()
    if (performance.now() < shown + kCountMilliseconds) return
    shown = performance.now()
    showCounts()
  }
  current
    .want(threshold, step)
    .then(async () => {
      if (session !== current) return
      refresh()
      if (current.reader.damage) say(current.reader.damage)
      await readPairs()
      saveState()
    })
    .catch((error) => session === current && say(error, () => setThreshold(threshold)))
  refresh()
  saveState()
}

// A number, or a share of the range with %.
function readThreshold(text: string) {
  const number = Number(text.trim().replace(/%$/, ''))
  if (text.trim() === '' || !Number.isFinite(number) || number < 0) {
    input.setAttribute('aria-invalid', 'true')
    return announce('This is no threshold: give a number from 0 on, or a share of the range like 1%.')
  }
  setThreshold(text.trim().endsWith('%') ? (number / 100) * range() : number)
}

function setColoring() {
  const coloring = coloringInput.value as Coloring
  for (const { picture } of views()) picture.setColoring(kColorings.includes(coloring) ? coloring : 'value')
  if (content) showContent()
}

function fit(axis?: number) {
  if (!space || !flat || !session) return
  const size = ({ place }: View) => [Math.max(1, place.clientWidth), Math.max(1, place.clientHeight)] as const
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [i & 1, (i >> 1) & 1, i >> 2].map((b) => 2 * b - 1))
  space.camera.reset(axis)
  space.camera.fit(box ? nodePlaces() : corners, ...size(space))
  flat.camera.reset()
  flat.camera.fit(corners.slice(0, 4), ...size(flat))
  redraw()
}

function* nodePlaces() {
  const { graph } = session!.reader
  const step = Math.max(1, Math.floor(graph.nodes / 5000))
  for (let i = 0; i < graph.nodes && graph.position.length > 0; i += step)
    yield [0, 1, 2].map((k) => (graph.position[3 * i + k] - box!.middle[k]) * box!.scale)
}

// After the next frame is drawn; a page that is hidden draws none.
const picture = () =>
  new Promise<void>((done) => {
    requestAnimationFrame(() => done())
    setTimeout(done, 200)
  })

let waiting = 0
function redraw() {
  if (waiting) return
  waiting = requestAnimationFrame(() => {
    waiting = 0
    const begin = performance.now()
    for (const { place, picture, camera } of views()) {
      const [width, height] = [Math.max(1, place.clientWidth), Math.max(1, place.clientHeight)]
      if (camera instanceof FlatCamera) camera.side = Math.min(width, height)
      picture.draw(camera, width, height)
      if (camera instanceof FlatCamera) showAxis(camera, width, height)
    }
    drawn.dataset.frame = (performance.now() - begin).toFixed(2)
    saveState()
  })
}

// The values at the left edge of the graph.
function showAxis(camera: Camera, width: number, height: number) {
  if (!session) return
  const { min, max } = session.reader.header
  const project = camera.projector(width, height)
  const ticks = max > min ? niceTicks(min, max) : [{ at: 0.5, text: shortNumber(min) }]
  const axis = element('axis')
  axis.replaceChildren(
    ...ticks.flatMap(({ at, text }) => {
      const y = project([-1, 2 * at - 1, 0])[1]
      if (y < 8 || y > height - 8) return []
      const label = document.createElement('span')
      label.style.top = `${y}px`
      label.textContent = text
      return [label]
    }),
  )
}

// Features.
function found(view: View, at: number[]): Found {
  return view.picture.find(view.camera, at)
}

// A frame that waits is never cancelled: where frames are slow, a moving pointer would put it off for ever.
let hovering = 0
let pointer: { view: View; at: number[] | null } | null = null
function hover(hovered: View, place: number[] | null) {
  pointer = { view: hovered, at: place }
  if (hovering) return
  hovering = requestAnimationFrame(() => {
    hovering = 0
    const { view, at } = pointer!
    const seen = at && session ? found(view, at) : {}
    tooltip.hidden = seen.node === undefined && seen.arc === undefined
    if (tooltip.hidden || !at) return
    tooltip.textContent = describe(seen)
    const corner = view.place.getBoundingClientRect()
    const left = Math.min(corner.left + at[0] + 14, innerWidth - tooltip.offsetWidth - 4)
    tooltip.style.left = `${Math.max(0, left)}px`
    tooltip.style.top = `${Math.max(0, Math.min(corner.top + at[1] + 14, innerHeight - tooltip.offsetHeight - 4))}px`
  })
}

function describe({ node, arc }: Found): string {
  const { graph, header } = session!.reader
  if (node !== undefined) {
    const names = { none: '', min: 'Minimum', max: 'Maximum', saddle: 'Fork', isolated: 'Isolated point' }
    const kind = names[kKinds[kindOf(content!, node)]]
    return `${kind} at vertex ${graph.vertex[node]}\nvalue ${shortNumber(graph.value[node])}\n${content!.down[node]} down, ${content!.up[node]} up`
  }
  const [lo, hi] = [graph.lo[arc!], graph.hi[arc!]]
  const died = graph.died[arc!]
  const end = died > header.steps ? 'stays at all levels' : `changes above threshold ${shortNumber(graph.persistenceOf(died))}`
  return `Arc from vertex ${graph.vertex[lo]} to ${graph.vertex[hi]}\nvalues ${shortNumber(graph.value[lo])} to ${shortNumber(graph.value[hi])}\n${end}`
}

function choose({ node, arc }: Found) {
  const { graph } = session!.reader
  if (node !== undefined) {
    // The feature that the node is part of, if the plots have it.
    const pair = marks.findIndex(({ lo, hi }) => lo === node || hi === node)
    if (pair >= 0) return choosePair(pair)
    return setChoice({ arc: kNoArc, nodes: [node], text: describe({ node }) })
  }
  if (arc !== undefined) return setChoice({ arc, nodes: [graph.lo[arc], graph.hi[arc]], text: describe({ arc }) })
  setChoice(null)
}

function choosePair(i: number) {
  const { mark, lo, hi } = marks[i]
  const [type, low, high, lowVertex, highVertex] = mark
  // A feature that this level no longer has is shown in one that has it.
  if (content && high - low < thresholdOf(content.version)) setThreshold(high - low)
  const { graph } = session!.reader
  let arc = kNoArc
  for (let k = 0; k < graph.records && arc === kNoArc; ++k)
    if (graph.lo[k] === lo && graph.hi[k] === hi && graph.isIn(k, content!.version)) arc = k
  setChoice({ arc, nodes: [lo, hi], text: `${type} from vertex ${lowVertex} to ${highVertex}, persistence ${shortNumber(high - low)}` })
}

function chooseVertices(vertices: number[]) {
  const { graph } = session!.reader
  const nodes = vertices.map((vertex) => graph.vertex.subarray(0, graph.nodes).indexOf(vertex)).filter((node) => node >= 0)
  const pair = marks.findIndex(({ lo, hi }) => lo === nodes[0] && hi === nodes[1])
  if (pair >= 0) choosePair(pair)
  else if (nodes.length === 2) {
    for (let arc = 0; arc < graph.records; ++arc)
      if (graph.lo[arc] === nodes[0] && graph.hi[arc] === nodes[1]) return choose({ arc })
  } else if (nodes.length === 1) choose({ node: nodes[0] })
}

function setChoice(made: Choice | null) {
  choice = made
  element('chosen').textContent = made ? `${made.text.replaceAll('\n', ', ')}.` : ''
  for (const mark of document.querySelectorAll<SVGElement>('[data-mark]')) {
    const { lo, hi } = marks[Number(mark.dataset.mark)]
    mark.classList.toggle('chosen', made !== null && made.nodes.length === 2 && made.nodes[0] === lo && made.nodes[1] === hi)
  }
  const isIn = content?.isIn
  for (const { picture } of views()) picture.choose(made?.arc ?? kNoArc, made && isIn ? made.nodes.filter(isIn) : [])
  redraw()
}

function showPlots() {
  const { reader, pairs } = session!
  const { graph, header } = reader
  const figures = element('figures')
  const message = element('plots-message')
  figures.replaceChildren()
  marks = []
  if (!pairs || pairs.type.length === 0) {
    message.textContent = 'The file has no pairs, so there is nothing to plot.'
    return
  }
  const all = [...pairs.type].map((type, i) => {
    const [lo, hi] = [pairs.lo[i], pairs.hi[i]]
    const mark: Mark = [kTypes[type & 3], graph.value[lo], graph.value[hi], graph.vertex[lo], graph.vertex[hi]]
    return { mark, lo, hi }
  })
  const size = ({ mark }: { mark: Mark }) => mark[2] - mark[1]
  all.sort((a, b) => size(b) - size(a))
  const steps: [number, number][] = []
  let loops = 0
  for (const pair of all) if (pair.mark[0] === 'Ext1' && size(pair) > 0) steps.push([size(pair), ++loops])
  const lasting = all.filter((pair) => size(pair) > 0)
  marks = lasting.slice(0, kMostMarks)
  const made = [
    steps.length > 0 ? loopsPlot(steps, range()) : null,
    persistenceDiagram(marks.map(({ mark }) => mark), header.min, header.max, lasting.length),
  ].filter((figure) => figure !== null)
  figures.append(...made)
  // Marks are drawn from small to large persistence.
  const shapes = [...figures.querySelectorAll<SVGElement>('#plot-diagram path:has(> title)')].reverse()
  shapes.forEach((shape, i) => (shape.dataset.mark = String(i)))
  const texts = []
  if (made.length === 0) texts.push('There are no pairs of positive persistence to plot.')
  if (all.length < header.pairs)
    texts.push(
      `Of ${count(header.pairs, 'pair')}, the plots have the ${all.length.toLocaleString('en')} most persistent ones, ` +
        'whose nodes are loaded; lower the threshold to load more.',
    )
  const zeros = all.length - lasting.length
  if (made.length > 0 && zeros > 0)
    texts.push(`${count(zeros, 'pair')} of persistence 0 ${zeros === 1 ? 'is' : 'are'} not drawn.`)
  message.textContent = texts.join(' ')
  if (content) showContent()
  setChoice(choice)
}

function showLevels() {
  const { levels } = session!.reader.header
  const rows = levels.map(({ threshold, nodes, arcs, fileBytes }) => [
    shortNumber(threshold), `${range() > 0 ? Number(((100 * threshold) / range()).toPrecision(3)) : 0} %`,
    nodes.toLocaleString('en'), arcs.toLocaleString('en'), bytesText(fileBytes), '',
  ])
  const table = makeTable('Levels', ['threshold', 'of range', 'nodes', 'arcs', 'bytes read', 'show'], rows)
  levels.forEach(({ threshold }, i) => {
    const button = document.createElement('button')
    button.type = 'button'
    button.textContent = 'Show'
    button.dataset.level = String(i)
    button.setAttribute('aria-label', `Show the level of threshold ${shortNumber(threshold)}`)
    button.addEventListener('click', () => setThreshold(threshold))
    table.tBodies[0].rows[i].cells[5].append(button)
  })
  element('levels').replaceChildren(table)
}

async function takeBackdrop(file: File) {
  try {
    if (!session || !content) throw new Error('Open a .reeb file first; then a mesh can be shown behind its skeleton.')
    if (!space || !session.reader.header.positions) throw new Error('There is no skeleton, so no mesh can be shown behind it.')
    const current = session
    const read = await readBackdrop(file)
    if (session !== current) return
    say(null)
    backdrop = read
    showBackdrop()
    showCounts()
  } catch (error) {
    say(error)
  }
}

function showBackdrop() {
  space?.picture.setBackdrop(backdrop && placed(backdrop, box!.middle, box!.scale))
  element('backdrop-name').textContent = backdrop ? `${backdrop.name}, ${count(backdrop.triangles.length / 3, 'triangle')}` : ''
  element('no-backdrop').hidden = backdrop === null
  redraw()
}

let saving = 0
function saveState() {
  clearTimeout(saving)
  saving = window.setTimeout(() => {
    if (!session || !space) return
    const { turn = 0, tilt = 0, zoom, target } = space.camera
    writeState({
      threshold: Number.isFinite(session.wanted) ? session.wanted : undefined,
      coloring: coloringInput.value,
      budget: session.budget === kDefaultBudget ? undefined : session.budget,
      camera: { turn, tilt, zoom, target },
      chosen: choice?.nodes.map((node) => session!.reader.graph.vertex[node]),
    })
  }, 300)
}

function openUrl(text: string) {
  const headers = element<HTMLTextAreaElement>('headers')
    .value.split('\n')
    .map((line) => /^\s*([!#$%&'*+.^_`|~\w-]+)\s*:\s*(.*?)\s*$/.exec(line))
    .filter((match) => match !== null)
    .map(([, name, value]) => [name, value] as [string, string])
  element<HTMLInputElement>('url').value = text
  try {
    const source = new HttpSource(text, headers, {
      progress: () => {
        if (source !== session?.source) element('subtitle').textContent = `Loading ... ${bytesText(source.loaded)}`
      },
      retrying: (what) => announce(`${what} Trying again.`),
    })
    void open(source)
  } catch (error) {
    say(error instanceof SourceError ? error : new SourceError(`"${text}" is not an address.`, 'It starts with http:// or https://.'))
  }
}

// Controls.
slider.addEventListener('input', () => {
  const begin = performance.now()
  setThreshold(thresholdAt(Number(slider.value)))
  drawn.dataset.script = (performance.now() - begin).toFixed(2)
})
input.addEventListener('change', () => readThreshold(input.value))
coloringInput.addEventListener('change', () => {
  setColoring()
  saveState()
})
budgetInput.addEventListener('change', () => {
  const budget = Number(budgetInput.value.replace(/[ ,_]/g, ''))
  const valid = Number.isInteger(budget) && budget >= 1
  budgetInput.toggleAttribute('aria-invalid', !valid)
  if (!valid) return announce('Give a number of arc records from 1 on.')
  session!.budget = budget
  setThreshold(Number.isFinite(session!.wanted) ? session!.wanted : 0)
})
element('stop').addEventListener('click', () => session?.pause())
for (const button of document.querySelectorAll<HTMLElement>('[data-view]'))
  button.addEventListener('click', () => fit({ x: 0, y: 1, z: 2 }[button.dataset.view!]))
element('picture').addEventListener('click', () => {
  for (const { place, picture } of views()) {
    const link = document.createElement('a')
    link.download = `${element('name').textContent}.${place.id}.png`
    link.href = picture.element.toDataURL('image/png')
    link.click()
  }
})
element('figures').addEventListener('click', (event) => {
  const mark = (event.target as Element).closest<SVGElement>('[data-mark]')
  if (mark) choosePair(Number(mark.dataset.mark))
})
addEventListener('keydown', (event) => event.key === 'Escape' && session && setChoice(null))
onThemeChange(() => {
  for (const { picture } of views()) picture.recolor()
  redraw()
})
element('fetch').addEventListener('submit', (event) => {
  event.preventDefault()
  openUrl(element<HTMLInputElement>('url').value.trim())
})
const take = (file: File | undefined) => {
  if (file && /\.ply$/i.test(file.name)) void takeBackdrop(file)
  else if (file) void open(new BlobSource(file, file.name))
}
element<HTMLInputElement>('pick').addEventListener('change', () => take(element<HTMLInputElement>('pick').files?.[0]))
element<HTMLInputElement>('backdrop').addEventListener('change', () => {
  const file = element<HTMLInputElement>('backdrop').files?.[0]
  if (file) void takeBackdrop(file)
})
element('no-backdrop').addEventListener('click', () => {
  backdrop = null
  element<HTMLInputElement>('backdrop').value = ''
  showBackdrop()
  showCounts()
})
for (const name of ['dragenter', 'dragover', 'dragleave', 'drop'])
  addEventListener(name, (event) => {
    event.preventDefault()
    document.body.classList.toggle('dropping', name === 'dragenter' || name === 'dragover')
  })
addEventListener('drop', (event) => take(event.dataTransfer?.files[0]))
const asked = new URLSearchParams(location.search).get('file')
if (asked) openUrl(asked)

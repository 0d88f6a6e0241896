// From a source to a file that is open.
import { count, digitsFor, shortNumber } from '../../web/data.js'
import { frameOf } from '../drawing/shapes'
import { FormatError } from '../reading/bytes'
import type { Header } from '../reading/header'
import { Session } from '../reading/session'
import { BlobSource, HttpSource, SourceError } from '../reading/source'
import type { Source } from '../reading/source'
import { nameFile, readState, saveNow, writeState } from './address'
import type { State } from './address'
import { showBackdrop } from './backdrop_control'
import { makeHover, setChoice } from './choice'
import { colorPictures, setColoring, showFirst } from './content'
import { choose, chooseVertices } from './features'
import { setThreshold, showBudget, showLevels } from './level_control'
import { announce, bytesText, element, say } from './page'
import { readPairs } from './plots_panel'
import { kDefaultBudget, OpenFile } from './state'
import type { Viewer } from './state'
import { fit, makeViews, nextPicture, showPlaces } from './views'

const kLegibleNodes = 200 // of the level that is shown first, beside those of the coarsest level
const subtitle = element('subtitle')
const coloringInput = element<HTMLSelectElement>('coloring')

// `again`: what a button offers if the file cannot be opened.
async function open(viewer: Viewer, source: Source, again: () => void) {
  const begin = performance.now()
  const state = stateFor(viewer, source)
  viewer.file?.close()
  viewer.source?.stop()
  viewer.source = source
  viewer.file = null
  nameFile(source instanceof HttpSource ? source.address : null)
  showNothing(source.name)
  try {
    const opening = Session.open(source, state.budget ?? kDefaultBudget)
    opening.catch(() => {}) // is waited for below
    startViews(viewer)
    const session = await opening
    // First what one frame has, whatever it is.
    await session.want(Infinity, () => {})
    if (viewer.source !== source) return
    performance.mark('reeb-bytes')
    const file = openFile(session, state)
    viewer.file = file
    await showFile(viewer, file, state)
    element('drawn').dataset.first = String(Math.round(performance.now() - begin))
    if (viewer.file !== file) return
    showLevels(viewer, file)
    const reading = setThreshold(viewer, file, session.wanted)
    await readPairs(viewer, file)
    await reading
    // Its nodes can be among the last that are read.
    if (viewer.file === file && state.chosen && !file.choice) chooseVertices(viewer, file, state.chosen)
  } catch (error) {
    if (viewer.source !== source) return
    say(error, again)
    if (!viewer.file) subtitle.textContent = 'This file could not be opened.'
  }
}

// While the first bytes are on their way.
function startViews(viewer: Viewer) {
  if (viewer.space) return
  try {
    makeViews(viewer, {
      hovered: makeHover(viewer),
      clicked: ({ picture, camera }, at) => viewer.file && choose(viewer, viewer.file, picture.find(camera, at)),
    })
  } catch {
    say(new Error('This browser has no WebGL, so there are no pictures of the graph. Plots and levels work.'))
  }
}

// The address has what is shown of a file. Of another file only colours and budget stay.
function stateFor(viewer: Viewer, source: Source): State {
  const before = viewer.source
  const isSame =
    before === null || before === source ||
    (before instanceof HttpSource && source instanceof HttpSource && before.url.href === source.url.href)
  saveNow(viewer)
  const { coloring, budget, ...others } = readState(viewer)
  if (isSame) return { coloring, budget, ...others }
  writeState(viewer, { coloring, budget })
  return { coloring, budget }
}

function showNothing(name: string) {
  element('view').hidden = true
  element('figures').replaceChildren()
  element('plots-message').textContent = element('chosen').textContent = ''
  element('tooltip').hidden = true
  element('name').textContent = name
  subtitle.textContent = 'Loading ...'
  document.title = `${name} - reeb viewer`
  say(null)
}

// The finest level that can be read by eye.
function legibleThreshold({ levels }: Header): number {
  const coarsest = levels[0]! // its nodes are in all levels
  return levels.filter(({ nodes }) => nodes <= coarsest.nodes + kLegibleNodes).pop()!.threshold
}

// THROWS: FormatError.
function openFile(session: Session, { threshold }: State): OpenFile {
  const { graph, header, damage } = session.reader
  if (graph.finest > header.steps) throw damage ?? new FormatError('the file has no complete version', session.source.size)
  session.wanted = threshold ?? legibleThreshold(header)
  return new OpenFile(session, graph.contentOf(graph.versionAt(session.wanted)), frameOf(graph))
}

// Ends when there is a picture.
async function showFile(viewer: Viewer, file: OpenFile, { coloring, camera }: State) {
  const { header } = file
  const digits = digitsFor(header.min, header.max)
  const [least, most] = [header.min, header.max].map((value) => shortNumber(value, digits))
  subtitle.textContent =
    `${header.name} from ${least} to ${most}; full graph: ${count(header.nodes, 'node')}, ` +
    `${count(header.arcs, 'arc')}, ${count(header.components, 'component')}, ${count(header.loops, 'loop')}`
  showBudget(file)
  element('scale-min').textContent = least
  element('scale-max').textContent = most
  closeDetails()
  element('view').hidden = false
  showPlaces(viewer, header)
  showBackdrop(viewer, file)
  coloringInput.value = coloring ?? 'value'
  colorPictures(viewer)
  showFirst(viewer, file)
  fit(viewer)
  if (camera && viewer.space) Object.assign(viewer.space.camera, camera)
  await nextPicture()
  performance.mark('reeb-picture')
}

// The keyboard stays where it was: at what opens a file.
function closeDetails() {
  const details = element<HTMLDetailsElement>('open')
  if (details.contains(document.activeElement)) details.querySelector('summary')!.focus()
  details.open = false
}

// What the address says, where it was changed by hand or by the history of the browser.
export async function applyState(viewer: Viewer, file: OpenFile, { threshold, coloring, budget, camera, chosen }: State) {
  if (camera && viewer.space) Object.assign(viewer.space.camera, camera)
  coloringInput.value = coloring ?? 'value'
  setColoring(viewer)
  file.session.budget = budget ?? kDefaultBudget
  showBudget(file)
  setChoice(viewer, file, null)
  await setThreshold(viewer, file, threshold ?? legibleThreshold(file.header))
  if (viewer.file === file && chosen && !file.choice) chooseVertices(viewer, file, chosen)
}

export function openBlob(viewer: Viewer, blob: File) {
  const source = new BlobSource(blob, blob.name)
  const again = () => void open(viewer, source, again)
  again()
}

export function openUrl(viewer: Viewer, text: string) {
  element<HTMLInputElement>('url').value = text
  element<HTMLInputElement>('pick').value = ''
  const headers = element<HTMLTextAreaElement>('headers')
    .value.split('\n')
    .map((line) => /^\s*([!#$%&'*+.^_`|~\w-]+)\s*:\s*(.*?)\s*$/.exec(line))
    .filter((match) => match !== null)
    .map(([, name, value]) => [name, value] as [string, string])
  let source: HttpSource
  try {
    source = new HttpSource(text, headers, {
      progress: () => {
        if (viewer.source === source && !viewer.file) subtitle.textContent = `Loading ... ${bytesText(source.loaded)}`
      },
      retrying: (what) => viewer.source === source && announce(`${what} Trying again.`),
    })
  } catch (error) {
    const wrong = new SourceError(`"${text}" is not an address.`, 'It starts with http:// or https://.')
    return say(error instanceof SourceError ? error : wrong)
  }
  void open(viewer, source, () => openUrl(viewer, text))
}

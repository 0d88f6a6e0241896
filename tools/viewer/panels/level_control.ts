// The threshold: by the slider, as a number, or from the table of levels.
import { parseThreshold, thresholdText } from '../../web/data.js'
import { kNoThreshold, refuse, take } from '../../web/note.js'
import { makeTable } from '../../web/table.js'
import type { Header } from '../reading/header'
import { saveState } from './address'
import { refresh } from './content'
import { showCounts } from './counts'
import { announce, bytesText, element, percentOf, say } from './page'
import { readPairs } from './plots_panel'
import { levelText, rangeOf } from './state'
import type { OpenFile, Viewer } from './state'

const kCountMilliseconds = 100 // between two texts about what was read
const kSteps = 1000 // of the slider
const slider = element<HTMLInputElement>('level')
const input = element<HTMLInputElement>('threshold')

// The slider is logarithmic: 0 is the threshold 0, its end the whole range.
function decades(header: Header): number {
  const range = rangeOf(header)
  const least = header.levels.map(({ threshold }) => threshold).filter((t) => t > 0).pop()
  if (!least || !(range > 0)) return 3
  return Math.min(14, Math.max(1, Math.log10(range / least) + 0.3))
}

export const thresholdAt = (header: Header, at: number) =>
  at <= 0 ? 0 : rangeOf(header) * 10 ** (-decades(header) * (1 - at / kSteps))

function placeOf(header: Header, threshold: number): number {
  const range = rangeOf(header)
  if (!(threshold > 0 && range > 0)) return 0
  return Math.max(1, Math.min(kSteps, kSteps * (1 + Math.log10(threshold / range) / decades(header))))
}

// Ends when what the threshold needs was read. `typed`: how it was asked for in the box.
export async function setThreshold(viewer: Viewer, file: OpenFile, threshold: number, typed: string | null = null): Promise<void> {
  const { session, graph, reader } = file
  slider.value = String(placeOf(file.header, threshold))
  const showInput = () => (input.value = typed ?? levelText(file, threshold))
  showInput()
  take(input)
  let shown = 0
  const changed = () => {
    if (viewer.file !== file) return
    // Pictures are made again when there is twice as much to see, not after each frame of the file.
    if (graph.records >= 2 * file.shapeRecords) return refresh(viewer, file)
    if (performance.now() < shown + kCountMilliseconds) return
    shown = performance.now()
    showCounts(viewer, file)
  }
  const reading = session.want(threshold, changed)
  refresh(viewer, file)
  saveState(viewer)
  try {
    await reading
    if (viewer.file !== file) return
    if (document.activeElement !== input) showInput() // now other levels are known
    refresh(viewer, file)
    if (reader.damage) say(reader.damage)
    await readPairs(viewer, file)
    saveState(viewer)
  } catch (error) {
    if (viewer.file !== file) return
    showCounts(viewer, file) // nothing is being read any more
    say(error, () => void setThreshold(viewer, file, threshold))
  }
}

// A number, or a share of the range with %.
export function readThreshold(viewer: Viewer, file: OpenFile) {
  const text = input.value.trim()
  const threshold = parseThreshold(text, rangeOf(file.header))
  if (threshold === null) {
    refuse(input, kNoThreshold)
    return announce(kNoThreshold)
  }
  void setThreshold(viewer, file, threshold, text)
}

export function showBudget({ session }: OpenFile) {
  const budgetInput = element<HTMLInputElement>('budget')
  budgetInput.value = String(session.budget)
  take(budgetInput)
}

export function readBudget(viewer: Viewer, file: OpenFile) {
  const budgetInput = element<HTMLInputElement>('budget')
  const budget = Number(budgetInput.value.replace(/[ ,_]/g, ''))
  if (!(Number.isInteger(budget) && budget >= 1)) {
    const why = 'Give a number of arc records from 1 on.'
    refuse(budgetInput, why)
    return announce(why)
  }
  take(budgetInput)
  file.session.budget = budget
  void setThreshold(viewer, file, file.session.wanted)
}

export function showLevels(viewer: Viewer, file: OpenFile) {
  const { levels } = file.header
  const rows = levels.map(({ threshold, nodes, arcs, fileBytes }) => [
    thresholdText(threshold), `${percentOf(threshold, rangeOf(file.header))} %`,
    nodes.toLocaleString('en'), arcs.toLocaleString('en'), bytesText(fileBytes), '',
  ])
  const table = makeTable('Levels', ['threshold', 'of range', 'nodes', 'arcs', 'bytes read', 'show'], rows)
  levels.forEach(({ threshold }, i) => {
    const button = document.createElement('button')
    button.type = 'button'
    button.textContent = 'Show'
    button.dataset.level = String(i)
    button.setAttribute('aria-label', `Show the level of threshold ${thresholdText(threshold)}`)
    button.addEventListener('click', () => void setThreshold(viewer, file, threshold))
    table.tBodies[0].rows[i].cells[5].append(button)
  })
  element('levels').replaceChildren(table)
}

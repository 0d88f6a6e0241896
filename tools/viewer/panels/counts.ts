// What is shown and what was read, in words; and in data attributes, for tests.
import { count } from '../../web/data.js'
import { take } from '../../web/note.js'
import { backdropBytes } from '../drawing/backdrop'
import { bytesText, element, percentOf } from './page'
import { levelText, rangeOf, thresholdOf, viewsOf } from './state'
import type { OpenFile, Viewer } from './state'

const drawn = element('drawn')

export function showCounts(viewer: Viewer, file: OpenFile) {
  const { content, graph, header } = file
  const { source, isReading } = file.session
  // Cancelling keeps components.
  const loops = content.arcs - content.nodes + header.components
  const texts = [count(content.nodes, 'node'), count(content.arcs, 'arc'), count(loops, 'loop')].join(', ')
  const percent = percentOf(thresholdOf(file, content.version), rangeOf(header))
  drawn.textContent =
    content.version === 0 ? `The full graph: ${texts}.` : `Features below ${percent} % of the range are removed: ${texts}.`
  Object.assign(drawn.dataset, {
    nodes: content.nodes, arcs: content.arcs, loops, version: content.version, finest: graph.finest,
    records: graph.records, loaded: source.loaded, memory: graph.memoryBytes, reading: isReading,
  })
  element('level').setAttribute('aria-valuetext', `${percent} per cent of the range: ${texts}`)
  for (const { place } of viewsOf(viewer))
    place.setAttribute('aria-label', `${place.id === 'space' ? 'The skeleton in space' : 'The graph by value'}: ${texts}`)
  const threshold = element<HTMLInputElement>('threshold')
  const level = levelText(file, thresholdOf(file, content.version))
  // What is wrong with the box stays there.
  if (!threshold.hasAttribute('aria-invalid')) take(threshold, threshold.value === level ? '' : `level ${level}`)
  element('loaded').textContent = loadedText(file)
  element('stop').hidden = !isReading
}

function loadedText({ session, graph, header, reader, shapeBytes, backdrop }: OpenFile): string {
  const { source, end, isReading, budget } = session
  const memory = graph.memoryBytes + shapeBytes.space + shapeBytes.flat + (backdrop ? backdropBytes(backdrop) : 0)
  const text =
    `${bytesText(Math.min(source.loaded, source.size))} read, of a file of ${bytesText(source.size)}; ${graph.records.toLocaleString('en')} of ` +
    `${header.records.toLocaleString('en')} arc records, at most ${budget.toLocaleString('en')}; ${bytesText(memory)} of memory.`
  if (isReading) return `${text} Loading finer levels ...`
  if (end === 'budget') return `${text} The budget is reached: this is the finest level within it.`
  if (end === 'damage') return `${text} No finer level can be read: ${reader.damage!.message}.`
  return text
}

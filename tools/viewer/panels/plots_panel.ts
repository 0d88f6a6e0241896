// The persistence diagram and the loops above a persistence: of the pairs whose nodes were read.
import { count } from '../../web/data.js'
import { loopsPlot, persistenceDiagram } from '../../web/plots.js'
import type { Pairs } from '../reading/frame'
import { setChoice } from './choice'
import { showContent } from './content'
import { element, say } from './page'
import { rangeOf } from './state'
import type { Mark, OpenFile, Viewer } from './state'

const kMostMarks = 1000
const kTypes = ['Ext0', 'Ext1', 'Ord0', 'Rel1']

// Reads the pairs and shows them, once for what was read of the graph.
export function readPairs(viewer: Viewer, file: OpenFile): Promise<void> {
  const { nodes } = file.graph
  if (file.pairs?.nodes !== nodes) file.pairs = { nodes, shown: showPairs(viewer, file) }
  return file.pairs.shown
}

async function showPairs(viewer: Viewer, file: OpenFile) {
  const { graph } = file
  // Features of more persistence are in the finest version that was read, so their pairs are known.
  const known = graph.persistenceOf(graph.finest)
  try {
    const pairs = await file.reader.readPairs()
    if (viewer.file === file) showPlots(viewer, file, pairs, known)
  } catch (error) {
    if (viewer.file !== file) return
    file.pairs = null
    element('plots-message').textContent = `There are no plots: ${(error as Error).message}.`
    say(error)
  }
}

// What would load more pairs.
function moreText({ session }: OpenFile): string {
  if (session.end === 'damage') return 'the rest of the file cannot be read'
  return session.end === 'budget' ? 'raise the budget to load more' : 'lower the threshold to load more'
}

function showPlots(viewer: Viewer, file: OpenFile, pairs: Pairs, known: number) {
  const { header } = file
  const all = pairsBySize(file, pairs)
  const lasting = all.filter((pair) => sizeOf(pair) > 0)
  file.marks = lasting.slice(0, kMostMarks)
  const steps: [number, number][] = []
  let loops = 0
  for (const pair of lasting) if (pair.drawn[0] === 'Ext1') steps.push([sizeOf(pair), ++loops])
  const made = [
    steps.length > 0 ? loopsPlot(steps, rangeOf(header), known, moreText(file)) : null,
    persistenceDiagram(file.marks.map(({ drawn }) => drawn), header.min, header.max, lasting.length),
  ].filter((figure) => figure !== null)
  element('figures').replaceChildren(...made)
  nameMarks()
  const zeros = all.length - lasting.length
  element('plots-message').textContent = plotsText(made.length > 0, all.length, header.pairs, zeros, moreText(file))
  showContent(viewer, file)
  setChoice(viewer, file, file.choice)
}

const sizeOf = ({ drawn: [, low, high] }: Mark) => high - low

function pairsBySize({ graph }: OpenFile, pairs: Pairs): Mark[] {
  const all = Array.from(pairs.type, (type, i): Mark => {
    const [lo, hi] = [pairs.lo[i], pairs.hi[i]]
    return { drawn: [kTypes[type & 3], graph.value[lo], graph.value[hi], graph.vertex[lo], graph.vertex[hi]], lo, hi }
  })
  return all.sort((a, b) => sizeOf(b) - sizeOf(a))
}

// The marks get their numbers. Who has no pointer chooses them one after the other, by keys.
function nameMarks() {
  const diagram = document.querySelector<SVGElement>('#plot-diagram svg')
  if (!diagram) return
  // They are drawn from small to large persistence.
  const shapes = [...diagram.querySelectorAll<SVGElement>('path:has(> title)')].reverse()
  shapes.forEach((shape, i) => (shape.dataset.mark = String(i)))
  diagram.setAttribute('tabindex', '0')
  diagram.setAttribute(
    'aria-label',
    `Persistence diagram of ${count(shapes.length, 'pair')}. Left and right arrow keys choose one after the other, the most persistent first.`,
  )
}

function plotsText(hasPlots: boolean, pairs: number, ofFile: number, zeros: number, more: string): string {
  if (pairs === 0) return 'The file has no pairs, so there is nothing to plot.'
  const texts = []
  if (!hasPlots) texts.push('There are no pairs of positive persistence to plot.')
  if (pairs < ofFile)
    texts.push(
      `Of ${count(ofFile, 'pair')}, the plots have the ${pairs.toLocaleString('en')} most persistent ones, ` +
        `whose nodes are loaded; ${more}.`,
    )
  if (hasPlots && zeros > 0) texts.push(`${count(zeros, 'pair')} of persistence 0 ${zeros === 1 ? 'is' : 'are'} not drawn.`)
  return texts.join(' ')
}

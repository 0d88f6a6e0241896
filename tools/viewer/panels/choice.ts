// The feature that is lit up, and what is said of nodes and arcs.
import { digitsFor, shortNumber, thresholdText } from '../../web/data.js'
import { kKinds, kNoArc } from '../drawing/picture'
import type { Found } from '../drawing/picture'
import type { VersionContent } from '../reading/loaded_graph'
import { element } from './page'
import { viewsOf } from './state'
import type { Choice, OpenFile, View, Viewer } from './state'
import { redraw } from './views'

// As in kKinds.
export function kindOf({ up, down, isIn }: VersionContent, node: number): number {
  if (up[node] + down[node] === 0) return isIn(node) ? 4 : 0
  return down[node] === 0 ? 1 : up[node] === 0 ? 2 : 3
}

export function describe({ graph, header, content }: OpenFile, { node, arc }: Found): string {
  const valueText = (at: number) => shortNumber(graph.value[at], digitsFor(header.min, header.max))
  if (node !== undefined) {
    const names = { none: '', min: 'Minimum', max: 'Maximum', saddle: 'Fork', isolated: 'Isolated point' }
    const kind = names[kKinds[kindOf(content, node)]]
    return `${kind} at vertex ${graph.vertex[node]}\nvalue ${valueText(node)}\n${content.down[node]} down, ${content.up[node]} up`
  }
  const [lo, hi] = [graph.lo[arc!], graph.hi[arc!]]
  const died = graph.died[arc!]
  const end = died > header.steps ? 'stays at all levels' : `changes above threshold ${thresholdText(graph.persistenceOf(died))}`
  return `Arc from vertex ${graph.vertex[lo]} to ${graph.vertex[hi]}\nvalues ${valueText(lo)} to ${valueText(hi)}\n${end}`
}

// Null: nothing.
export function setChoice(viewer: Viewer, file: OpenFile, made: Choice | null) {
  file.choice = made
  element('chosen').textContent = made ? `${made.text.replaceAll('\n', ', ')}.` : ''
  for (const mark of document.querySelectorAll<SVGElement>('[data-mark]')) {
    const { lo, hi } = file.marks[Number(mark.dataset.mark)]
    mark.classList.toggle('chosen', made !== null && made.nodes.length === 2 && made.nodes[0] === lo && made.nodes[1] === hi)
  }
  lightUp(viewer, file)
  redraw(viewer)
}

// The choice, in the pictures.
export function lightUp(viewer: Viewer, { choice, content }: OpenFile) {
  for (const { picture } of viewsOf(viewer)) picture.choose(choice?.arc ?? kNoArc, choice?.nodes.filter(content.isIn) ?? [])
}

// Says what is under the pointer. A frame that waits is never cancelled: where frames are slow, a moving pointer would
// put it off for ever.
export function makeHover(viewer: Viewer): (view: View, at: number[] | null) => void {
  const tooltip = element('tooltip')
  let waiting = 0
  let pointer: { view: View; at: number[] | null }
  return (hovered, place) => {
    pointer = { view: hovered, at: place }
    if (waiting) return
    waiting = requestAnimationFrame(() => {
      waiting = 0
      const { view, at } = pointer
      const seen = at && viewer.file ? view.picture.find(view.camera, at) : {}
      tooltip.hidden = seen.node === undefined && seen.arc === undefined
      if (tooltip.hidden || !at || !viewer.file) return
      tooltip.textContent = describe(viewer.file, seen)
      const corner = view.place.getBoundingClientRect()
      const left = Math.min(corner.left + at[0] + 14, innerWidth - tooltip.offsetWidth - 4)
      tooltip.style.left = `${Math.max(0, left)}px`
      tooltip.style.top = `${Math.max(0, Math.min(corner.top + at[1] + 14, innerHeight - tooltip.offsetHeight - 4))}px`
    })
  }
}

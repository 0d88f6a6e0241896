// From a click, a key or the address to a feature that is lit up.
import { shortNumber } from '../../web/data.js'
import { kNoArc } from '../drawing/picture'
import type { Found } from '../drawing/picture'
import { describe, setChoice } from './choice'
import { setThreshold } from './level_control'
import { thresholdOf } from './state'
import type { OpenFile, Viewer } from './state'

export function choose(viewer: Viewer, file: OpenFile, { node, arc }: Found) {
  const { graph, marks } = file
  if (node !== undefined) {
    // The feature that the node is part of, if the plots have it.
    const pair = marks.findIndex(({ lo, hi }) => lo === node || hi === node)
    if (pair >= 0) return choosePair(viewer, file, pair)
    return setChoice(viewer, file, { arc: kNoArc, nodes: [node], text: describe(file, { node }) })
  }
  if (arc === undefined) return setChoice(viewer, file, null)
  setChoice(viewer, file, { arc, nodes: [graph.lo[arc], graph.hi[arc]], text: describe(file, { arc }) })
}

// kNoArc: no arc of the version that is shown.
function arcBetween({ graph, content }: OpenFile, lo: number, hi: number): number {
  for (let arc = 0; arc < graph.records; ++arc)
    if (graph.lo[arc] === lo && graph.hi[arc] === hi && graph.isIn(arc, content.version)) return arc
  return kNoArc
}

export function choosePair(viewer: Viewer, file: OpenFile, i: number) {
  const { drawn, lo, hi } = file.marks[i]
  const [type, low, high, lowVertex, highVertex] = drawn
  // A feature that this level no longer has is shown in one that has it.
  if (high - low < thresholdOf(file, file.content.version)) void setThreshold(viewer, file, high - low)
  const text = `${type} from vertex ${lowVertex} to ${highVertex}, persistence ${shortNumber(high - low)}`
  setChoice(viewer, file, { arc: arcBetween(file, lo, hi), nodes: [lo, hi], text })
}

// The next or the previous one in the order of persistence.
export function chooseBeside(viewer: Viewer, file: OpenFile, step: 1 | -1) {
  const { marks, choice } = file
  if (marks.length === 0) return
  const at = choice ? marks.findIndex(({ lo, hi }) => choice.nodes[0] === lo && choice.nodes[1] === hi) : -1
  choosePair(viewer, file, Math.min(marks.length - 1, Math.max(0, at + step)))
}

export function chooseVertices(viewer: Viewer, file: OpenFile, vertices: number[]) {
  const { graph, marks } = file
  const known = graph.vertex.subarray(0, graph.nodes)
  const nodes = vertices.map((vertex) => known.indexOf(vertex)).filter((node) => node >= 0)
  const pair = marks.findIndex(({ lo, hi }) => lo === nodes[0] && hi === nodes[1])
  if (pair >= 0) return choosePair(viewer, file, pair)
  if (nodes.length === 1) return choose(viewer, file, { node: nodes[0] })
  const arc = arcBetween(file, nodes[0], nodes[1])
  if (arc !== kNoArc) choose(viewer, file, { arc })
}

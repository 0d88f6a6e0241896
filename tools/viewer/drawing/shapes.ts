// Where nodes and arcs are drawn: in the shape of the mesh, and laid out by value. Both fill the cube from -1 to 1.
// Shapes take long where there are many arcs, so they are made step by step.
import { kFewNodes, roomOf } from '../../web/marks.js'
import type { LoadedGraph, VersionContent } from '../reading/loaded_graph'

export const kLargeRoom = 1e9 // of nodes whose marks are never small
const kStep = 2048 // nodes or arcs

// Segments of all arcs that were read; which of them are drawn depends on the version.
export interface Shape {
  nodes: Float32Array // x, y, z
  start: Float32Array // of each segment
  end: Float32Array
  part: Float32Array // value at start and end, from 0 to 1 of the range
  life: Uint32Array // born, died
  arc: Uint32Array
  length: Float32Array // of each arc record
}

export function shapeBytes(shape: Shape): number {
  return Object.values(shape).reduce((sum, list) => sum + list.byteLength, 0)
}

// Maps positions into the cube: chosen once, so that pictures do not jump while more is read.
export interface Frame {
  middle: number[]
  scale: number
}

export interface Box {
  least: number[]
  most: number[]
}

// Of lists of coordinates. Empty: from Infinity to -Infinity.
export function boxOf(lists: (Float32Array | Float64Array)[]): Box {
  const least = [Infinity, Infinity, Infinity]
  const most = [-Infinity, -Infinity, -Infinity]
  for (const list of lists)
    for (let i = 0; i < list.length; ++i) {
      least[i % 3] = Math.min(least[i % 3], list[i])
      most[i % 3] = Math.max(most[i % 3], list[i])
    }
  return { least, most }
}

export const boxOfGraph = (graph: LoadedGraph) =>
  boxOf([graph.position.subarray(0, 3 * graph.nodes), graph.bucketMean.subarray(0, 3 * graph.buckets)])

export function frameOf(graph: LoadedGraph): Frame {
  const { least, most } = boxOfGraph(graph)
  if (!least.every(Number.isFinite) || !most.every(Number.isFinite)) return { middle: [0, 0, 0], scale: 1 }
  const size = Math.hypot(...most.map((x, k) => x - least[k]))
  return { middle: most.map((x, k) => x / 2 + least[k] / 2), scale: size > 0 ? 2 / size : 1 }
}

function partOf(graph: LoadedGraph): (value: number) => number {
  const { min, max } = graph.header
  return (value) => (max > min ? (value - min) / (max - min) : 0.5)
}

// All zeros.
export function makeShape(nodes: Float32Array, segments: number, arcs: number): Shape {
  return {
    nodes,
    start: new Float32Array(3 * segments),
    end: new Float32Array(3 * segments),
    part: new Float32Array(2 * segments),
    life: new Uint32Array(2 * segments),
    arc: new Uint32Array(segments),
    length: new Float32Array(arcs),
  }
}

// Through the means of the buckets of each arc.
export function* skeletonShape(graph: LoadedGraph, { middle, scale }: Frame): Generator<void, Shape> {
  const nodes = new Float32Array(3 * graph.nodes)
  for (let i = 0; i < nodes.length; ++i) nodes[i] = (graph.position[i] - middle[i % 3]) * scale
  const { lo, hi, value, firstBucket, bucketMean, bucketIndex, born, died } = graph
  const part = partOf(graph)
  const width = 2 ** graph.header.bucketExponent
  const shape = makeShape(nodes, graph.records + graph.buckets, graph.records)
  const records = graph.records // more may be read meanwhile
  let at = 0
  const point = [0, 0, 0, 0]
  const before = [0, 0, 0, 0]
  for (let arc = 0; arc < records; ++arc) {
    if (arc % kStep === 0) yield
    const [low, high] = [part(value[lo[arc]]), part(value[hi[arc]])]
    const [first, last] = [firstBucket[arc], firstBucket[arc + 1]]
    for (let k = 0; k < 3; ++k) before[k] = nodes[3 * lo[arc] + k]
    before[3] = low
    for (let i = first; i <= last; ++i) {
      for (let k = 0; k < 3; ++k)
        point[k] = i < last ? (bucketMean[3 * i + k] - middle[k]) * scale : nodes[3 * hi[arc] + k]
      point[3] = i < last ? Math.min(high, Math.max(low, part((bucketIndex[i] + 0.5) * width))) : high
      put(shape, at++, before, point, arc, born[arc], died[arc])
      for (let k = 0; k < 4; ++k) before[k] = point[k]
    }
  }
  return shape
}

function put(shape: Shape, at: number, from: number[], to: number[], arc: number, born: number, died: number) {
  for (let k = 0; k < 3; ++k) {
    shape.start[3 * at + k] = from[k]
    shape.end[3 * at + k] = to[k]
  }
  shape.part[2 * at] = from[3]
  shape.part[2 * at + 1] = to[3]
  shape.life[2 * at] = born
  shape.life[2 * at + 1] = died
  shape.arc[at] = arc
  shape.length[arc] += Math.hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2])
}

// The rooms of the nodes of a version (marks.js).
export function roomsOf(graph: LoadedGraph, { version, nodes, up, down }: VersionContent, { length }: Shape): Float32Array {
  const rooms = new Float32Array(up.length)
  if (nodes <= kFewNodes) return rooms.fill(kLargeRoom)
  const { lo, hi } = graph
  for (let i = 0; i < length.length; ++i) {
    if (!graph.isIn(i, version)) continue
    const [a, b] = [lo[i], hi[i]]
    const room = roomOf(length[i], down[a] === 0 && up[a] === 1 && up[b] === 0 && down[b] === 1)
    if (room > rooms[a]) rooms[a] = room
    if (room > rooms[b]) rooms[b] = room
  }
  return rooms
}

// A place from 0 to 1 across for each node of a version, NaN for others: the ends of a spanning tree one after the
// other, every other node in the middle of what follows it in the tree.
function* acrossOf(graph: LoadedGraph, content: VersionContent): Generator<void, Float64Array> {
  const { lo, hi, records } = graph
  const nodes = content.down.length
  const degree = new Uint32Array(nodes + 1)
  for (let i = 0; i < nodes; ++i) degree[i + 1] = degree[i] + content.down[i] + content.up[i]
  const fill = degree.slice()
  const others = new Uint32Array(degree[nodes])
  for (let arc = 0; arc < records; ++arc) {
    if (arc % kStep === 0) yield
    if (!graph.isIn(arc, content.version)) continue
    others[fill[lo[arc]]++] = hi[arc]
    others[fill[hi[arc]]++] = lo[arc]
  }
  const across = new Float64Array(nodes).fill(NaN)
  const order = yield* upwards(graph, content)
  const seen = new Uint8Array(nodes)
  const sum = new Float64Array(nodes)
  const children = new Uint32Array(nodes)
  let places = 0
  let steps = 0
  for (const root of order) {
    if (seen[root]) continue
    seen[root] = 1
    const path = [root]
    const next = [degree[root]]
    while (path.length > 0) {
      if (++steps % kStep === 0) yield
      const node = path[path.length - 1]
      let at = next[next.length - 1]
      while (at < degree[node + 1] && seen[others[at]]) ++at
      next[next.length - 1] = at + 1
      if (at < degree[node + 1]) {
        seen[others[at]] = 1
        path.push(others[at])
        next.push(degree[others[at]])
        continue
      }
      path.pop()
      next.pop()
      across[node] = children[node] > 0 ? sum[node] / children[node] : places++
      const parent = path[path.length - 1]
      if (parent === undefined) continue
      sum[parent] += across[node]
      ++children[parent]
    }
  }
  for (let i = 0; i < nodes; ++i) across[i] = places > 1 ? across[i] / (places - 1) : across[i] + 0.5
  return across
}

// The nodes of a version by their values; the order of those within 1/4096 of the range does not matter.
function* upwards(graph: LoadedGraph, content: VersionContent): Generator<void, Uint32Array> {
  const kBins = 4096
  const part = partOf(graph)
  const nodes = content.down.length
  const bin = new Uint16Array(nodes)
  const first = new Uint32Array(kBins + 1)
  for (let i = 0; i < nodes; ++i) {
    if (i % kStep === 0) yield
    bin[i] = Math.min(kBins - 1, Math.floor(part(graph.value[i]) * kBins))
    if (content.isIn(i)) ++first[bin[i] + 1]
  }
  for (let k = 0; k < kBins; ++k) first[k + 1] += first[k]
  const order = new Uint32Array(content.nodes)
  for (let i = 0; i < nodes; ++i) {
    if (i % kStep === 0) yield
    if (content.isIn(i)) order[first[bin[i]]++] = i
  }
  return order
}

// By value upwards. The nodes of `content` spread over the whole picture; others are where they are in `finest`.
export function* flatShape(graph: LoadedGraph, content: VersionContent, finest: VersionContent): Generator<void, Shape> {
  const { lo, hi, value, born, died, records } = graph
  const count = content.down.length
  const part = partOf(graph)
  const spare = yield* acrossOf(graph, finest)
  const across = finest === content ? spare : yield* acrossOf(graph, content)
  const nodes = new Float32Array(3 * count)
  for (let i = 0; i < count; ++i) {
    if (i % kStep === 0) yield
    const x = Number.isNaN(across[i]) ? spare[i] : across[i]
    nodes[3 * i] = Number.isNaN(x) ? 0 : 2 * x - 1
    nodes[3 * i + 1] = 2 * part(value[i]) - 1
  }
  // Arcs between the same nodes bend, so that each is seen.
  const shape = makeShape(nodes, 2 * records, records)
  const same = new Map<number, number>()
  for (let arc = 0; arc < records; ++arc) {
    if (arc % kStep === 0) yield
    const [a, b] = [3 * lo[arc], 3 * hi[arc]]
    const key = lo[arc] * count + hi[arc]
    const rank = same.get(key) ?? 0
    same.set(key, rank + 1)
    const [low, high] = [part(value[lo[arc]]), part(value[hi[arc]])]
    const bend = (rank % 2 === 1 ? 1 : -1) * Math.ceil(rank / 2) * Math.min(0.08, 0.3 * (high - low) + 0.01)
    const from = [nodes[a], nodes[a + 1], 0, low]
    const to = [nodes[b], nodes[b + 1], 0, high]
    const middle = from.map((x, k) => (x + to[k]) / 2 + (k === 0 ? bend : 0))
    put(shape, 2 * arc, from, middle, arc, born[arc], died[arc])
    put(shape, 2 * arc + 1, middle, to, arc, born[arc], died[arc])
  }
  return shape
}

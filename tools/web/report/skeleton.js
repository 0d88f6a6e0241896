// All levels of a skeleton: what is drawn at a threshold.
//
// An arc is a record that the versions from `born` to before `died` have. Cancelling a feature joins arcs, so a coarser
// level has other records, not only fewer.
import { numbers16 } from '../data.js'
import { kFewNodes, roomOf } from '../marks.js'

export class Skeleton {
  constructor(json) {
    this.box = json.box
    this.values = json.values
    this.hasPositions = json.positions
    this.levels = json.levels
    this.isolated = json.isolated
    this.nodes = { vertex: json.nodes.vertex, value: json.nodes.value, place: unit(numbers16(json.nodes.place)) }
    this.arcs = { ...json.arcs, line: unit(numbers16(json.arcs.line)), width: unit(numbers16(json.arcs.width)) }
    this.first = new Uint32Array(this.arcs.points.length + 1) // of the inner points of each arc
    this.arcs.points.forEach((points, i) => (this.first[i + 1] = this.first[i] + points))
    // The box is scaled to the cube from -1 to 1, with its middle at the origin.
    const most = [0, 0, 0]
    for (let i = 0; i < this.nodes.place.length; ++i) most[i % 3] = Math.max(most[i % 3], this.nodes.place[i])
    for (let i = 0; i < this.arcs.line.length; ++i)
      if (i % 4 < 3) most[i % 4] = Math.max(most[i % 4], this.arcs.line[i])
    this.middle = most.map((side) => side / 2)
    this.radius = Math.max(1e-6, Math.hypot(...this.middle) * 2)
    this.lengths = Float32Array.from(this.arcs.points, (_, arc) => lengthOf(this.line(arc))) // of arcs, in the scene
  }

  // All points of all levels, to see how large they look.
  *points() {
    for (let i = 0; i < this.nodes.place.length; i += 3) yield this.centered(this.nodes.place, i)
    for (let i = 0; i < this.arcs.line.length; i += 4) yield this.centered(this.arcs.line, i)
  }

  get levelCount() {
    return this.levels.version.length
  }

  // The finest level that this threshold yields, as `reeb extract --threshold` has it.
  levelAt(threshold) {
    let level = 0
    while (level + 1 < this.levelCount && this.levels.threshold[level + 1] <= threshold) ++level
    return level
  }

  // The arcs and nodes of a level, with the numbers of arcs down and up at each node.
  at(level) {
    const version = this.levels.version[level]
    const { lo, hi, born, died } = this.arcs
    const arcs = []
    const down = new Map()
    const up = new Map()
    for (const node of this.isolated) down.set(node, 0)
    for (let i = 0; i < lo.length; ++i) {
      if (born[i] > version || (died[i] !== null && died[i] <= version)) continue
      arcs.push(i)
      up.set(lo[i], (up.get(lo[i]) ?? 0) + 1)
      down.set(hi[i], (down.get(hi[i]) ?? 0) + 1)
    }
    const nodes = [...new Set([...up.keys(), ...down.keys()])].sort((a, b) => a - b)
    const kind = (node) => {
      const below = down.get(node) ?? 0
      const above = up.get(node) ?? 0
      if (below + above === 0) return 'isolated'
      return below === 0 ? 'min' : above === 0 ? 'max' : 'saddle'
    }
    return { level, arcs, nodes, kinds: nodes.map(kind), rooms: this.rooms(arcs, nodes, down, up), down, up }
  }

  // Of each node (marks.js).
  rooms(arcs, nodes, down, up) {
    if (nodes.length <= kFewNodes) return nodes.map(() => Infinity)
    const { lo, hi } = this.arcs
    const room = new Map(nodes.map((node) => [node, 0]))
    for (const arc of arcs) {
      const isLone = !down.get(lo[arc]) && up.get(lo[arc]) === 1 && !up.get(hi[arc]) && down.get(hi[arc]) === 1
      const here = roomOf(this.lengths[arc], isLone)
      for (const node of [lo[arc], hi[arc]]) room.set(node, Math.max(room.get(node), here))
    }
    return nodes.map((node) => room.get(node))
  }

  // The place of a node in the scene.
  place(node) {
    return this.centered(this.nodes.place, 3 * node)
  }

  centered(list, at) {
    return [0, 1, 2].map((k) => ((list[at + k] - this.middle[k]) * 2) / this.radius)
  }

  // A position of the mesh in the scene.
  placeOf(position) {
    const scaled = position.map((x, k) => (this.box.size > 0 ? (x - this.box.min[k]) / this.box.size : 0))
    return this.centered(scaled, 0)
  }

  // The points of an arc in the scene, from its lower node to its upper one, with values from 0 to 1 of the range, and
  // widths in pixels, which grow with the radius of the contour.
  line(arc) {
    const points = [{ at: this.place(this.arcs.lo[arc]), value: this.part(this.nodes.value[this.arcs.lo[arc]]) }]
    for (let i = this.first[arc]; i < this.first[arc + 1]; ++i)
      points.push({ at: this.centered(this.arcs.line, 4 * i), value: this.arcs.line[4 * i + 3] })
    points.push({ at: this.place(this.arcs.hi[arc]), value: this.part(this.nodes.value[this.arcs.hi[arc]]) })
    points.forEach((point, i) => (point.width = 2 + 4 * this.arcs.width[this.first[arc] + 2 * arc + i]))
    return points
  }

  part(value) {
    return this.values.size > 0 ? (value - this.values.min) / this.values.size : 0.5
  }

  // The threshold from which on an arc is gone; null if it never is.
  endOf(arc) {
    const died = this.arcs.died[arc]
    if (died === null) return null
    const level = this.levels.version.findIndex((version) => version >= died)
    return level < 0 ? null : this.levels.threshold[level]
  }
}

function lengthOf(line) {
  let length = 0
  for (let i = 1; i < line.length; ++i) length += Math.hypot(...line[i].at.map((x, k) => x - line[i - 1].at[k]))
  return length
}

function unit(numbers) {
  return Float32Array.from(numbers, (q) => q / 65535)
}

// What was read of a graph so far: columns of nodes, arc records, buckets and versions, and what belongs to a version.
import { FormatError } from './bytes'
import { kNever } from './frame'
import type { FrameHeader, GraphFrame } from './frame'
import type { Header } from './header'

type Numbers = Float64Array<ArrayBufferLike> | Uint32Array<ArrayBufferLike>

// A list of numbers that grows, a quarter more than needed.
class Column<T extends Numbers> {
  size = 0

  constructor(public list: T) {}

  append(more: T) {
    const size = this.size + more.length
    if (size > this.list.length) {
      const longer = new (this.list.constructor as new (n: number) => T)(size + (size >> 2))
      longer.set(this.list.subarray(0, this.size))
      this.list = longer
    }
    this.list.set(more, this.size)
    this.size = size
  }
}

const floats = () => new Column<Float64Array>(new Float64Array(0))
const integers = () => new Column<Uint32Array>(new Uint32Array(0))

// A version: its arcs in the order of the file, and how many arcs go down and up from each node.
export interface VersionContent {
  version: number
  arcs: number
  nodes: number
  buckets: number
  down: Uint32Array // of every node that was read
  up: Uint32Array
  isIn: (node: number) => boolean
}

export class LoadedGraph {
  // The finest version that is complete.
  finest: number
  private readonly columns = {
    value: floats(), vertex: floats(), position: floats(),
    lo: integers(), hi: integers(), born: integers(), died: integers(), firstBucket: integers(),
    bucketIndex: floats(), bucketCount: floats(), bucketMean: floats(), bucketRim: floats(),
    persistence: floats(), nodesOf: floats(), arcsOf: floats(), bucketsOf: floats(),
  }
  // 1 for each node that a record names; the others are isolated points.
  private named = new Uint8Array(0)

  constructor(readonly header: Header) {
    this.finest = header.steps + 1
    this.columns.firstBucket.append(new Uint32Array(1))
  }

  get nodes() { return this.columns.value.size }
  get records() { return this.columns.lo.size }
  get buckets() { return this.columns.bucketIndex.size }
  get versions() { return this.columns.persistence.size }
  get value() { return this.columns.value.list }
  get vertex() { return this.columns.vertex.list }
  get position() { return this.columns.position.list }
  get lo() { return this.columns.lo.list }
  get hi() { return this.columns.hi.list }
  get born() { return this.columns.born.list }
  get died() { return this.columns.died.list }
  get firstBucket() { return this.columns.firstBucket.list } // of each record, and the end of the last
  get bucketIndex() { return this.columns.bucketIndex.list }
  get bucketCount() { return this.columns.bucketCount.list }
  get bucketMean() { return this.columns.bucketMean.list }
  get bucketRim() { return this.columns.bucketRim.list } // empty in files of version 1

  // Bytes that the columns take.
  get memoryBytes() {
    return Object.values(this.columns).reduce((sum, { list }) => sum + list.byteLength, this.named.byteLength)
  }

  // The persistence of the cancellation that made a version; 0 for version 0. The version must have been read.
  persistenceOf(version: number): number {
    return this.columns.persistence.list[this.header.steps - version]
  }

  // The finest version that some threshold yields; steps + 1 if no version is complete.
  get finestOffered(): number {
    let version = this.finest
    while (version > 0 && version < this.header.steps && !(this.persistenceOf(version + 1) > this.persistenceOf(version))) ++version
    return version
  }

  // The version that a threshold yields, if it is finer than all that were read, the finest of those.
  versionAt(threshold: number): number {
    // Cancelling below t is strict, and persistences do not fall with the version.
    let [low, high] = [this.finest, this.header.steps]
    if (low > high) return low
    while (low < high) {
      const middle = Math.ceil((low + high) / 2)
      if (middle === 0 || this.persistenceOf(middle) < threshold) low = middle
      else high = middle - 1
    }
    return Math.max(low, this.finestOffered)
  }

  // The total order of vertices.
  private isBelow(a: number, b: number): boolean {
    const { value, vertex } = this
    return value[a] < value[b] || (value[a] === value[b] && vertex[a] < vertex[b])
  }

  // A frame whose rules are broken changes nothing. THROWS: FormatError.
  append(frame: FrameHeader, read: GraphFrame) {
    const fail = (what: string): never => {
      throw new FormatError(what, frame.offset)
    }
    const { header, columns } = this
    if (frame.finest + frame.versions !== this.finest || frame.finest > header.steps + 1)
      fail('the versions of a frame do not continue those before')
    for (let i = 0; i < frame.versions; ++i) {
      const before = i > 0 ? read.persistence[i - 1] : this.versions > 0 ? this.persistenceOf(this.finest) : Infinity
      if (!(read.persistence[i] >= 0 && read.persistence[i] <= before)) fail('the persistence of a version rises')
    }
    if (this.nodes + frame.nodes > header.nodes || this.records + frame.records > header.records)
      fail('there are more nodes or arc records than the header says')
    for (let i = 0; i < frame.nodes; ++i) {
      if (!Number.isFinite(read.value[i])) fail('the value of a node is not finite')
      if (read.vertex[i] < 0) fail('a node has a negative vertex')
      if (i === 0) continue
      const [a, b] = [read.value[i - 1], read.value[i]]
      if (!(a < b || (a === b && read.vertex[i - 1] < read.vertex[i]))) fail('a node is not above the one before it')
    }
    const sizes = Object.entries(columns).map(([name, column]) => [name, column.size] as const)
    columns.value.append(read.value)
    columns.vertex.append(read.vertex)
    columns.position.append(read.position)
    try {
      this.checkRecords(frame, read, fail)
    } catch (error) {
      for (const [name, size] of sizes) columns[name as keyof typeof columns].size = size
      throw error
    }
    columns.lo.append(Uint32Array.from(read.lo))
    columns.hi.append(Uint32Array.from(read.hi))
    columns.born.append(read.born)
    columns.died.append(read.died)
    columns.bucketIndex.append(read.bucketIndex)
    columns.bucketCount.append(read.bucketCount)
    columns.bucketMean.append(read.bucketMean)
    columns.bucketRim.append(read.bucketRim)
    let end = columns.firstBucket.list[columns.firstBucket.size - 1]
    columns.firstBucket.append(Uint32Array.from(read.lo, (_, i) => (end += read.buckets.length > 0 ? read.buckets[i] : 0)))
    for (const name of ['persistence', 'nodesOf', 'arcsOf', 'bucketsOf'] as const) columns[name].append(read[name])
    if (this.nodes > this.named.length) {
      const longer = new Uint8Array(this.nodes + (this.nodes >> 2))
      longer.set(this.named)
      this.named = longer
    }
    for (let i = 0; i < frame.records; ++i) this.named[read.lo[i]] = this.named[read.hi[i]] = 1
    this.finest = frame.finest
  }

  private checkRecords(frame: FrameHeader, read: GraphFrame, fail: (what: string) => never) {
    const { header } = this
    let before = { died: kNever, lo: -1, hi: -1, born: -1 }
    if (this.records > 0) {
      const last = this.records - 1
      before = { died: this.died[last], lo: this.lo[last], hi: this.hi[last], born: this.born[last] }
    }
    for (let i = 0; i < frame.records; ++i) {
      const record = { died: read.died[i], lo: read.lo[i], hi: read.hi[i], born: read.born[i] }
      const { died, lo, hi, born } = record
      if (born >= died || born > header.steps) fail('an arc is not born before it dies')
      if (died > header.steps && died !== kNever) fail('an arc dies after the last version')
      if (lo < 0 || hi < 0 || lo >= this.nodes || hi >= this.nodes) fail('an arc names a node that was not introduced')
      if (!this.isBelow(lo, hi)) fail('an arc does not go up')
      if (Math.min(died - 1, header.steps) >= this.finest) fail('an arc comes after its version was complete')
      const { lo: lower, hi: upper } = before
      const inOrder =
        lower < 0 || died < before.died ||
        (died === before.died &&
          (this.isBelow(lower, lo) ||
            (lower === lo && (this.isBelow(upper, hi) || (upper === hi && before.born <= born)))))
      if (!inOrder) fail('arcs are out of order')
      before = record
    }
  }

  isIn(record: number, version: number): boolean {
    return this.born[record] <= version && version < this.died[record]
  }

  // THROWS: FormatError if the version has other counts than its frame says. It must be complete.
  contentOf(version: number): VersionContent {
    const { lo, hi, born, died, firstBucket, named } = this
    const down = new Uint32Array(this.nodes)
    const up = new Uint32Array(this.nodes)
    let [arcs, nodes, buckets] = [0, 0, 0]
    for (let i = 0; i < this.records; ++i) {
      if (born[i] > version || version >= died[i]) continue
      ++arcs
      ++up[lo[i]]
      ++down[hi[i]]
      buckets += firstBucket[i + 1] - firstBucket[i]
    }
    const isIn = (node: number) => down[node] + up[node] > 0 || named[node] === 0
    for (let i = 0; i < this.nodes; ++i) if (isIn(i)) ++nodes
    const at = this.header.steps - version
    const { nodesOf, arcsOf, bucketsOf } = this.columns
    if (nodes !== nodesOf.list[at] || arcs !== arcsOf.list[at] || buckets !== bucketsOf.list[at])
      throw new FormatError(`version ${version} has other counts than its frame says`, this.header.headerBytes)
    return { version, arcs, nodes, buckets, down, up, isIn }
  }
}

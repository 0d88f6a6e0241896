// Reads a .reeb file from its start, as far as wanted: docs/FORMAT.md.
import { Cursor, FormatError } from './bytes'
import { makeDigest } from './digest'
import type { Digest } from './digest'
import { decodeGraphFrame, decodePairsFrame, kFrameHeaderBytes, readFrameHeader } from './frame'
import type { FrameHeader, Pairs } from './frame'
import { headerBytes, kFixedBytes, readHeader } from './header'
import type { Header } from './header'
import { LoadedGraph } from './loaded_graph'
import type { Source } from './source'

const kFirstBytes = 2 ** 16
const kMostBytes = 2 ** 22
const kEndMark = [0x52, 0x45, 0x45, 0x42, 0x45, 0x4e, 0x44, 0x0a]

// A window into the file that only moves forward. What it asks for doubles, so that few requests read a lot, and
// little is read when little is needed.
class Window {
  private bytes = new Uint8Array(0)
  private begin = 0
  private step = kFirstBytes

  constructor(private readonly source: Source) {}

  // The bytes from `begin`, fewer only at the end of the file. Those before `begin` are not needed any more.
  async at(begin: number, size: number): Promise<Uint8Array> {
    this.bytes = this.bytes.subarray(begin - this.begin)
    this.begin = begin
    const known = begin + this.bytes.length
    if (this.bytes.length < size && !(known >= this.source.size)) {
      const more = await this.source.read(known, known + Math.max(size - this.bytes.length, this.step))
      this.step = Math.min(2 * this.step, kMostBytes)
      const all = new Uint8Array(this.bytes.length + more.length)
      all.set(this.bytes)
      all.set(more, this.bytes.length)
      this.bytes = all
    }
    return this.bytes.subarray(0, size)
  }
}

// Why no more was read.
export type End = 'wanted' | 'budget' | 'all' | 'damage'

export class Reader {
  readonly graph: LoadedGraph
  // What is wrong with the file after the versions that were read.
  damage: FormatError | null = null
  private frames = 0
  private next: number

  private constructor(
    private readonly source: Source,
    private readonly window: Window,
    private readonly digest: Digest,
    readonly header: Header,
  ) {
    this.graph = new LoadedGraph(header)
    this.next = header.headerBytes
  }

  // THROWS: FormatError, and what the source throws.
  static async open(source: Source): Promise<Reader> {
    const digest = await makeDigest()
    const window = new Window(source)
    const size = headerBytes(await window.at(0, kFixedBytes), source.size)
    return new Reader(source, window, digest, readHeader(await window.at(0, size), digest))
  }

  get bytesRead() {
    return this.next
  }

  get isComplete() {
    return this.frames === this.header.graphFrames
  }

  // Reads one more graph frame, unless it would lead to more than `mostRecords` arc records. A frame that breaks a rule
  // is the end of what can be read. THROWS: what the source throws.
  async readFrame(mostRecords = Infinity): Promise<End | null> {
    if (this.damage) return 'damage'
    if (this.isComplete) return 'all'
    try {
      const frame = readFrameHeader(await this.whole(this.next, kFrameHeaderBytes), this.next, 'graph')
      if (this.graph.records + frame.records > mostRecords) return 'budget'
      const bytes = await this.whole(this.next, kFrameHeaderBytes + frame.storedBytes)
      this.graph.append(frame, decodeGraphFrame(this.header, frame, bytes, this.digest))
      this.next += bytes.length
      ++this.frames
      this.checkLevels()
      if (this.isComplete) this.checkAll()
      return null
    } catch (error) {
      if (!(error instanceof FormatError)) throw error
      this.damage = error
      return 'damage'
    }
  }

  // Reads until the version is complete.
  async readTo(version: number, mostRecords = Infinity): Promise<End> {
    while (this.graph.finest > version) {
      const end = await this.readFrame(mostRecords)
      if (end) return end
    }
    return 'wanted'
  }

  // The most persistent pairs, in the order of cancelling: of the last frames as many as have nodes that were read, and
  // all pairs once all graph frames were read. THROWS: FormatError, and what the source throws.
  async readPairs(): Promise<Pairs> {
    const { graphFrames, pairFrames } = this.header
    if (pairFrames === 0) return join([])
    const offsets = await this.seekTable()
    const found: Pairs[] = []
    for (let i = graphFrames + pairFrames; i-- > graphFrames; ) {
      const size = offsets[i + 1] - offsets[i]
      const bytes = await this.source.read(offsets[i], offsets[i + 1])
      if (bytes.length < kFrameHeaderBytes) throw new FormatError('the file ends in a frame', offsets[i])
      const frame: FrameHeader = readFrameHeader(bytes.subarray(0, kFrameHeaderBytes), offsets[i], 'pairs')
      if (frame.storedBytes + kFrameHeaderBytes !== size || bytes.length !== size)
        throw new FormatError('a frame has another size than the seek table says', offsets[i])
      const pairs = decodePairsFrame(frame, bytes, this.digest)
      const { nodes, value, vertex } = this.graph
      let first = pairs.lo.length
      while (first > 0 && pairs.lo[first - 1] < nodes && pairs.hi[first - 1] < nodes) {
        const [lo, hi] = [pairs.lo[--first], pairs.hi[first]]
        if (lo < 0 || hi < 0) throw new FormatError('a pair names a node that does not exist', offsets[i])
        if (value[hi] < value[lo] || (value[hi] === value[lo] && vertex[hi] < vertex[lo]))
          throw new FormatError('the upper node of a pair is below its lower one', offsets[i])
      }
      if (first > 0 && this.isComplete) throw new FormatError('a pair names a node that does not exist', offsets[i])
      found.unshift({ type: pairs.type.subarray(first), lo: pairs.lo.subarray(first), hi: pairs.hi.subarray(first) })
      if (first > 0) break
    }
    const pairs = join(found)
    if (this.isComplete && pairs.type.length !== this.header.pairs)
      throw new FormatError('the number of pairs is not that of the header', offsets[graphFrames])
    return pairs
  }

  // The offsets of all frames, and the end of the last. THROWS: FormatError if there is no valid tail.
  private async seekTable(): Promise<number[]> {
    const frames = this.header.graphFrames + this.header.pairFrames
    const begin = this.source.size - 8 * frames - 24
    const cut = (): never => {
      throw new FormatError('the file was cut or is damaged: its end is missing', Math.max(0, begin))
    }
    if (begin < this.header.headerBytes) cut()
    const bytes = await this.source.read(begin, this.source.size)
    if (kEndMark.some((byte, i) => bytes[bytes.length - 8 + i] !== byte)) cut()
    const cursor = new Cursor(bytes, begin)
    const offsets = Array.from({ length: frames + 1 }, () => cursor.u64())
    if (cursor.digest() !== this.digest([bytes.subarray(0, 8 * (frames + 1))])) cut()
    const ascending = offsets.every((offset, i) => i === 0 || offset >= offsets[i - 1] + kFrameHeaderBytes)
    if (offsets[0] !== this.header.headerBytes || offsets[frames] !== begin || !ascending) cut()
    return offsets
  }

  private async whole(begin: number, size: number): Promise<Uint8Array> {
    const bytes = await this.window.at(begin, size)
    if (bytes.length < size) throw new FormatError('the file was cut: it ends in a frame', begin)
    return bytes
  }

  // The lines of the level table that these frames complete.
  private checkLevels() {
    for (const line of this.header.levels) {
      if (line.frames !== this.frames) continue
      if (line.fileBytes !== this.next || line.version < this.graph.finest)
        throw new FormatError('the level table contradicts the frames', this.header.headerBytes)
    }
  }

  private checkAll() {
    const { graph, header } = this
    if (graph.finest !== 0 || graph.nodes !== header.nodes || graph.records !== header.records)
      throw new FormatError('the graph has other counts than the header says', this.next)
  }
}

function join(parts: Pairs[]): Pairs {
  const size = parts.reduce((sum, { type }) => sum + type.length, 0)
  const all: Pairs = { type: new Uint8Array(size), lo: new Float64Array(size), hi: new Float64Array(size) }
  let at = 0
  for (const part of parts) {
    for (const name of ['type', 'lo', 'hi'] as const) all[name].set(part[name], at)
    at += part.type.length
  }
  return all
}

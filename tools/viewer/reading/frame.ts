// Frames of a .reeb file, decoded one at a time.
import { decompress } from 'fzstd'
import { Cursor, FormatError } from './bytes'
import type { Digest } from './digest'
import type { Header } from './header'

export const kFrameHeaderBytes = 40
export const kNever = 2 ** 32 - 1
const kMostRawBytes = 2 ** 27

export interface FrameHeader {
  kind: 'graph' | 'pairs'
  offset: number
  storedBytes: number
  rawBytes: number
  nodes: number // or pairs
  records: number
  versions: number
  finest: number
}

export interface GraphFrame {
  persistence: Float64Array // of each version, from coarse to fine
  nodesOf: Float64Array // of each version
  arcsOf: Float64Array
  bucketsOf: Float64Array
  value: Float64Array
  vertex: Float64Array
  position: Float64Array // x, y, z of each node; empty without positions
  died: Uint32Array
  born: Uint32Array
  lo: Float64Array
  hi: Float64Array
  buckets: Uint32Array // of each record
  bucketIndex: Float64Array
  bucketCount: Float64Array
  bucketMean: Float64Array // x, y, z of each bucket
  bucketRim: Float64Array // the same; empty in version 1
}

export interface Pairs {
  type: Uint8Array // 0 Ext0, 1 Ext1, 2 Ord0, 3 Rel1; plus 4 for a loop that no rule could cancel
  lo: Float64Array
  hi: Float64Array
}

// `bytes`: the 40 bytes at `offset` of the file. THROWS: FormatError.
export function readFrameHeader(bytes: Uint8Array, offset: number, wanted: 'graph' | 'pairs'): FrameHeader {
  const cursor = new Cursor(bytes, offset)
  const kind = cursor.u32()
  if (kind !== (wanted === 'graph' ? 1 : 2)) throw new FormatError(`there is no ${wanted} frame`, offset)
  const frame: FrameHeader = {
    kind: wanted,
    offset,
    storedBytes: cursor.u32(),
    rawBytes: cursor.u32(),
    nodes: cursor.u32(),
    records: cursor.u32(),
    versions: cursor.u32(),
    finest: cursor.u32(),
  }
  if (cursor.u32() !== 0) throw new FormatError('reserved bytes of a frame are not 0', offset + 28)
  if (frame.rawBytes > kMostRawBytes || frame.storedBytes > frame.rawBytes)
    throw new FormatError('a frame cannot have this size', offset + 4)
  if (wanted === 'pairs' && (frame.records !== 0 || frame.versions !== 0 || frame.finest !== 0))
    throw new FormatError('a pairs frame has records or versions', offset + 16)
  return frame
}

// The payload, uncompressed; its checksum is right. THROWS: FormatError.
function payload(frame: FrameHeader, bytes: Uint8Array, digest: Digest): Cursor {
  const stored = bytes.subarray(kFrameHeaderBytes)
  const sum = new Cursor(bytes.subarray(32, 40), frame.offset + 32).digest()
  if (digest([bytes.subarray(0, 32), stored]) !== sum)
    throw new FormatError('a frame is damaged: its checksum is wrong', frame.offset + 32)
  if (stored.length === frame.rawBytes) return new Cursor(stored, frame.offset + kFrameHeaderBytes)
  let raw: Uint8Array
  try {
    raw = decompress(stored, new Uint8Array(frame.rawBytes))
  } catch (error) {
    throw new FormatError(`a frame cannot be uncompressed: ${(error as Error).message}`, frame.offset + 40)
  }
  if (raw.length !== frame.rawBytes) throw new FormatError('a frame has another size than it says', frame.offset + 8)
  return new Cursor(raw, frame.offset + kFrameHeaderBytes)
}

// The vertex of each bucket that is on its rim: from codes, as singles next to the mean. One vertex is its own rim.
// THROWS: FormatError.
function rims(cursor: Cursor, count: Float64Array, mean: Float64Array): Float64Array {
  const several = count.reduce((sum, n) => sum + (n > 1 ? 1 : 0), 0)
  if (16 * several > cursor.left) cursor.fail('a frame has no room for its buckets')
  const [first, second] = [cursor.planes(several), cursor.planes(several)]
  const spreads = new Float32Array(first.buffer)
  const single = new Float32Array(1)
  const bits = new Uint32Array(single.buffer)
  const rim = (code: number, middle: number) => {
    single[0] = middle
    const place = bits[0] >>> 31 ? ~bits[0] : bits[0] | 0x80000000
    const moved = (place + (code & 1 ? -((code >>> 1) + 1) : code >>> 1)) >>> 0
    bits[0] = moved >>> 31 ? moved & 0x7fffffff : ~moved
    return single[0]
  }
  const found = mean.slice()
  let at = 0
  for (let i = 0; i < count.length; ++i) {
    if (count[i] <= 1) continue
    if (!(spreads[2 * at] >= 0) || spreads[2 * at] === Infinity) cursor.fail('the spread of a bucket is not a number from 0')
    const codes = [first[2 * at + 1], second[2 * at], second[2 * at + 1]]
    for (let k = 0; k < 3; ++k) {
      found[3 * i + k] = rim(codes[k], mean[3 * i + k])
      if (!Number.isFinite(found[3 * i + k])) cursor.fail('the rim of a bucket is not finite')
    }
    ++at
  }
  return found
}

// `bytes`: the whole frame, its header included. THROWS: FormatError.
export function decodeGraphFrame(header: Header, frame: FrameHeader, bytes: Uint8Array, digest: Digest): GraphFrame {
  const cursor = payload(frame, bytes, digest)
  const hasRims = header.embedding && header.fileVersion === 2
  const { versions, nodes, records } = frame
  // The least that these numbers take, before anything is reserved for them.
  const least =
    versions * (header.embedding ? 11 : 10) + nodes * (header.positions ? 33 : 9) + records * (header.embedding ? 5 : 4)
  if (least > cursor.left) throw new FormatError('a frame has no room for what it says', frame.offset + 12)
  const persistence = cursor.floats(versions)
  const [nodesOf, arcsOf, bucketsOf] = [0, 1, 2].map(() => new Float64Array(versions))
  const counts = header.embedding ? [nodesOf, arcsOf, bucketsOf] : [nodesOf, arcsOf]
  for (let i = 0; i < versions; ++i) for (const list of counts) list[i] = cursor.delta(i > 0 ? list[i - 1] : 0)
  const value = cursor.values(nodes)
  const vertex = new Float64Array(nodes)
  for (let i = 0; i < nodes; ++i) vertex[i] = cursor.delta(i > 0 ? vertex[i - 1] : 0)
  const triples = (n: number) => {
    const list = new Float64Array(3 * n)
    for (let k = 0; k < 3; ++k) cursor.floats(n).forEach((x, i) => (list[3 * i + k] = x))
    return list
  }
  const position = header.positions ? triples(nodes) : new Float64Array(0)
  const died = new Uint32Array(records)
  const born = new Uint32Array(records)
  let sinceNever = 0
  for (let i = 0; i < records; ++i) {
    sinceNever += cursor.varint()
    if (sinceNever > kNever) cursor.fail('an arc dies before version 0')
    died[i] = kNever - sinceNever
  }
  for (let i = 0; i < records; ++i) {
    const number = cursor.varint()
    if (number >= kNever) cursor.fail('an arc is born after all versions')
    born[i] = number
  }
  const lo = new Float64Array(records)
  const hi = new Float64Array(records)
  for (let i = 0; i < records; ++i) lo[i] = cursor.delta(i > 0 ? lo[i - 1] : 0)
  for (let i = 0; i < records; ++i) hi[i] = cursor.delta(lo[i])
  const buckets = new Uint32Array(header.embedding ? records : 0)
  let total = 0
  for (let i = 0; i < buckets.length; ++i) {
    const number = cursor.varint()
    total += number
    if (total * 26 > cursor.left + 26 * records) cursor.fail('a frame has no room for its buckets')
    buckets[i] = number
  }
  if (total * 26 > cursor.left) cursor.fail('a frame has no room for its buckets')
  const bucketIndex = new Float64Array(total)
  const bucketCount = new Float64Array(total)
  for (let i = 0; i < total; ++i) bucketIndex[i] = cursor.delta(i > 0 ? bucketIndex[i - 1] : 0)
  for (let i = 0; i < total; ++i) bucketCount[i] = cursor.varint()
  const bucketMean = triples(total)
  const bucketRim = hasRims ? rims(cursor, bucketCount, bucketMean) : new Float64Array(0)
  if (cursor.left > 0) cursor.fail('a frame has bytes left over')
  return {
    persistence, nodesOf, arcsOf, bucketsOf, value, vertex, position,
    died, born, lo, hi, buckets, bucketIndex, bucketCount, bucketMean, bucketRim,
  }
}

// `bytes`: the whole frame, its header included. THROWS: FormatError.
export function decodePairsFrame(frame: FrameHeader, bytes: Uint8Array, digest: Digest): Pairs {
  const cursor = payload(frame, bytes, digest)
  const n = frame.nodes
  if (3 * n > cursor.left) throw new FormatError('a frame has no room for what it says', frame.offset + 12)
  const type = cursor.take(n).slice()
  for (const t of type)
    if (t > 5 || t === 4) throw new FormatError('a pair has an unknown type', frame.offset + kFrameHeaderBytes)
  const lo = new Float64Array(n)
  const hi = new Float64Array(n)
  for (let i = 0; i < n; ++i) lo[i] = cursor.delta(i > 0 ? lo[i - 1] : 0)
  for (let i = 0; i < n; ++i) hi[i] = cursor.delta(lo[i])
  if (cursor.left > 0) cursor.fail('a frame has bytes left over')
  return { type, lo, hi }
}

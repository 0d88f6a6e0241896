// The header region of a .reeb file.
import { Cursor, FormatError } from './bytes'
import type { Digest } from './digest'

export const kFixedBytes = 176
const kMagic = [0x89, 0x52, 0x45, 0x45, 0x42, 0x0d, 0x0a, 0x1a]
const kFragment = [...'REEBFRG\n'].map((letter) => letter.charCodeAt(0))
const kLevelBytes = 56
const kMostNameBytes = 4096

export interface Level {
  version: number
  frames: number
  threshold: number
  nodes: number
  arcs: number
  buckets: number
  fileBytes: number
  memoryBytes: number
}

export interface Header {
  fileVersion: number
  graphOnly: boolean
  positions: boolean
  embedding: boolean
  headerBytes: number
  min: number
  max: number
  meshVertices: number
  meshTriangles: number
  nodes: number
  arcs: number
  components: number
  loops: number
  records: number
  pairs: number
  keptLoops: number
  denoiseThreshold: number
  denoisedPairs: number
  bucketExponent: number
  steps: number
  graphFrames: number
  pairFrames: number
  levels: Level[]
  name: string
}

// How large the region is, from its first bytes. THROWS: FormatError.
export function headerBytes(fixed: Uint8Array, fileBytes: number): number {
  const cursor = new Cursor(fixed, 0)
  if (kFragment.every((byte, i) => fixed[i] === byte))
    throw new FormatError('this is a fragment, a part of a run, and not a Reeb graph: `reeb glue` makes a Reeb graph of the fragments of all parts', 0)
  if (fixed.length < 8 || kMagic.some((byte, i) => fixed[i] !== byte))
    throw new FormatError('this is not a .reeb file: it starts with other bytes', 0)
  cursor.take(8)
  const version = cursor.u32()
  if (version !== 1 && version !== 2)
    throw new FormatError(`the file has version ${version}; this page reads versions 1 and 2`, 8)
  if (fixed.length < kFixedBytes) throw new FormatError('the file ends in its header', fixed.length)
  cursor.u32()
  const size = cursor.u64()
  if (size > fileBytes) throw new FormatError('the header is larger than the file', 16)
  const most = kFixedBytes + kMostNameBytes + 8 + kLevelBytes * 2 ** 20
  if (size < kFixedBytes + 8 || size > most) throw new FormatError('the header cannot have this size', 16)
  return size
}

// THROWS: FormatError.
export function readHeader(bytes: Uint8Array, digest: Digest): Header {
  const cursor = new Cursor(bytes, 0)
  const rule = (holds: boolean, what: string, offset = cursor.offset) => {
    if (!holds) throw new FormatError(what, offset)
  }
  const sum = new Cursor(bytes.subarray(bytes.length - 8), bytes.length - 8).digest()
  rule(digest([bytes.subarray(0, -8)]) === sum, 'the header is damaged: its checksum is wrong', bytes.length - 8)
  cursor.take(8)
  const fileVersion = cursor.u32()
  const flags = cursor.u32()
  rule(flags < 8, 'the header has unknown flags', 12)
  rule(fileVersion === 1 || (flags & 4) !== 0, 'a file of version 2 has no embedding', 8)
  const header: Header = {
    fileVersion,
    graphOnly: (flags & 1) !== 0,
    positions: (flags & 2) !== 0,
    embedding: (flags & 4) !== 0,
    headerBytes: cursor.u64(),
    min: cursor.f64(),
    max: cursor.f64(),
    meshVertices: cursor.u64(),
    meshTriangles: cursor.u64(),
    nodes: cursor.u64(),
    arcs: cursor.u64(),
    components: cursor.u64(),
    loops: cursor.u64(),
    records: cursor.u64(),
    pairs: cursor.u64(),
    keptLoops: cursor.u64(),
    denoiseThreshold: cursor.f64(),
    denoisedPairs: cursor.u64(),
    bucketExponent: (cursor.digest(), cursor.i32()),
    steps: cursor.u32(),
    graphFrames: cursor.u32(),
    pairFrames: cursor.u32(),
    levels: [],
    name: '',
  }
  rule(Number.isFinite(header.min) && Number.isFinite(header.max), 'the range of the function is not finite', 24)
  rule(header.min <= header.max, 'the range of the function is empty', 24)
  rule(header.loops === header.arcs - header.nodes + header.components, 'the number of loops is wrong', 80)
  rule(header.steps < 2 ** 32 - 1, 'there are too many cancellations', 140)
  rule(header.graphFrames + header.pairFrames > 0, 'there are no frames', 144)
  const levels = cursor.u32()
  const nameBytes = cursor.u32()
  rule(levels > 0, 'there are no levels', 152)
  rule(nameBytes <= kMostNameBytes, 'the name of the function is too long', 156)
  rule(cursor.take(16).every((byte) => byte === 0), 'reserved bytes are not 0', 160)
  rule(kFixedBytes + nameBytes + kLevelBytes * levels + 8 === bytes.length, 'the sizes in the header do not add up', 16)
  header.name = new TextDecoder().decode(cursor.take(nameBytes))
  for (let i = 0; i < levels; ++i) {
    const offset = cursor.offset
    const line: Level = {
      version: cursor.u32(),
      frames: cursor.u32(),
      threshold: cursor.f64(),
      nodes: cursor.u64(),
      arcs: cursor.u64(),
      buckets: cursor.u64(),
      fileBytes: cursor.u64(),
      memoryBytes: cursor.u64(),
    }
    const before = header.levels[i - 1]
    rule(line.version <= header.steps && line.frames <= header.graphFrames, 'a level is out of range', offset)
    rule(line.threshold >= 0, 'a threshold is not a number', offset + 8)
    rule(
      !before || (line.version < before.version && line.threshold <= before.threshold && line.frames >= before.frames),
      'the levels are out of order',
      offset,
    )
    header.levels.push(line)
  }
  const last = header.levels[levels - 1]
  rule(last.version === 0 && last.frames === header.graphFrames, 'the last level is not the full graph', 176)
  rule(last.nodes === header.nodes && last.arcs === header.arcs, 'the last level has other counts than the graph', 176)
  if (header.graphOnly)
    rule(header.steps === 0 && header.pairs === 0 && levels === 1, 'a graph-only file has levels or pairs', 12)
  return header
}

// The reader of the viewer, which knows docs/FORMAT.md only: its levels are those that `reeb extract` writes, and it
// refuses what is damaged.
//
//   node reader_test.mjs SOURCE_FOLDER REEB PACKAGES WORK     WORK has scan.reeb
import { execFileSync } from 'node:child_process'
import { createRequire } from 'node:module'
import { readFileSync, writeFileSync } from 'node:fs'
import { join } from 'node:path'
import { bundled } from './bundled.mjs'
import { example } from './example.mjs'

const [source, reeb, packages, work] = process.argv.slice(2)
const { BlobSource, FormatError, Reader } = await bundled(source, 'reading/library', packages, work)
let failures = 0

function check(what, good, seen = '') {
  if (good) return
  console.log(`FAILED: ${what}: ${typeof seen === 'string' ? seen : JSON.stringify(seen)}`)
  ++failures
}

const open = (bytes) => Reader.open(new BlobSource(new Blob([bytes]), 'file'))
const run = (...words) => execFileSync(reeb, words, { cwd: work, encoding: 'utf8', maxBuffer: 2 ** 28 })

// The same random numbers in each run.
let state = 1
function random(below) {
  state = (Math.imul(state, 1664525) + 1013904223) >>> 0
  return Math.floor((state / 2 ** 32) * below)
}

// A level as `reeb extract` writes it.
function level(reader, version) {
  const { graph } = reader
  const content = graph.contentOf(version)
  const compare = (a, b) => graph.value[a] - graph.value[b] || graph.vertex[a] - graph.vertex[b]
  const nodes = []
  for (let i = 0; i < graph.nodes; ++i) if (content.isIn(i)) nodes.push(i)
  nodes.sort(compare)
  const arcs = []
  for (let i = 0; i < graph.records; ++i) if (graph.isIn(i, version)) arcs.push(i)
  arcs.sort((a, b) => compare(graph.lo[a], graph.lo[b]) || compare(graph.hi[a], graph.hi[b]) || a - b)
  const point = (list, i) => [...list.subarray(3 * i, 3 * i + 3)]
  return {
    nodes: nodes.map((i) => ({
      vertex: graph.vertex[i],
      value: graph.value[i],
      ...(reader.header.positions ? { position: point(graph.position, i) } : {}),
      down: content.down[i],
      up: content.up[i],
    })),
    arcs: arcs.map((i) => {
      const path = []
      for (let b = graph.firstBucket[i]; b < graph.firstBucket[i + 1]; ++b)
        path.push([...point(graph.bucketMean, b), graph.bucketCount[b]])
      return { lo: graph.vertex[graph.lo[i]], hi: graph.vertex[graph.hi[i]], path }
    }),
  }
}

function extracted(file, threshold) {
  const { nodes, arcs } = JSON.parse(run('extract', file, '--format', 'json', '--threshold', String(threshold)))
  return {
    nodes: nodes.map(({ vertex, value, position, down, up }) => ({ vertex, value, ...(position ? { position } : {}), down, up })),
    arcs: arcs.map(({ lo, hi, path }) => ({ lo, hi, path: path ?? [] })),
  }
}

// Parallel arcs can come in another order.
function same(what, seen, wanted) {
  const text = ({ nodes, arcs }) => JSON.stringify({ nodes, arcs: arcs.map((arc) => JSON.stringify(arc)).sort() })
  const [a, b] = [text(seen), text(wanted)]
  if (a === b) return
  let at = 0
  while (a[at] === b[at]) ++at
  check(what, false, `${a.slice(Math.max(0, at - 60), at + 60)} instead of ${b.slice(Math.max(0, at - 60), at + 60)}`)
}

async function compare(file, thresholds) {
  const reader = await open(readFileSync(file))
  for (const threshold of thresholds(reader.header)) {
    // As far as the threshold needs, and no further.
    let version = reader.graph.versionAt(threshold)
    while (!reader.isComplete && (reader.graph.finest > reader.header.steps || !(threshold > reader.graph.persistenceOf(version)))) {
      if (await reader.readFrame()) break
      version = reader.graph.versionAt(threshold)
    }
    check(`${file}: no damage`, reader.damage === null, reader.damage?.message)
    if (reader.header.nodes > 0 || reader.isComplete) same(`${file} at ${threshold}`, level(reader, version), extracted(file, threshold))
  }
  return reader
}

async function comparePairs(file, reader) {
  const { type, lo, hi } = await reader.readPairs()
  const names = ['Ext0', 'Ext1', 'Ord0', 'Rel1']
  const { value, vertex } = reader.graph
  const rows = [...type].map((t, i) => [names[t & 3], vertex[lo[i]], vertex[hi[i]], value[hi[i]] - value[lo[i]], t >> 2].join())
  const lines = run('pairs', file).trim().split('\n')
  const columns = lines[0].split(',')
  const at = ['type', 'lo', 'hi', 'persistence', 'kept'].map((name) => columns.indexOf(name))
  const wanted = lines.slice(1).map((line) => {
    const cells = line.split(',')
    return at.map((i, k) => (k === 0 ? cells[i] : String(Number(cells[i])))).join()
  })
  check(`${file}: pairs`, JSON.stringify(rows.sort()) === JSON.stringify(wanted.sort()), [rows.slice(0, 2), wanted.slice(0, 2)])
}

// Triangles between random vertices of a few values, so that there are loops, plateaus and isolated points.
function randomMesh(name) {
  const vertices = 3 + random(60)
  const levels = 2 + random(30)
  const lines = Array.from({ length: vertices }, () => [0, 0, 0].map(() => (random(levels) - levels / 2) / 7).join(' '))
  const triangles = Array.from({ length: random(2 * vertices) }, () => {
    const a = random(vertices)
    return `3 ${a} ${(a + 1 + random(3)) % vertices} ${(a + 1 + random(vertices - 1)) % vertices}`
  })
  writeFileSync(name, ['OFF', `${vertices} ${triangles.length} 0`, ...lines, ...triangles, ''].join('\n'))
}

// A bucket of such a function is one unit in the last place wide, so its index has 53 bits.
async function nearlyConstant() {
  for (const [base, step] of [[1, 0], [-7.25, 0], [1e-30, 0], [100, 2 ** -46], [-1e6, 2 ** -33], [1e9, 1e-6]]) {
    const side = 10
    const at = Array.from({ length: side * side }, (_, i) => [i % side, Math.floor(i / side)])
    const quads = at.filter(([x, y]) => x > 0 && y > 0).map(([x, y]) => y * side + x)
    writeFileSync(join(work, 'flat.off'), [
      'OFF', `${at.length} ${quads.length} 0`,
      ...at.map(([x, y]) => `${x} ${y} ${base + step * ((x * y) % 7)}`),
      ...quads.map((i) => `4 ${i - side - 1} ${i - side} ${i} ${i - 1}`), '',
    ].join('\n'))
    run('compute', join(work, 'flat.off'), '--quiet', '--force', '-o', join(work, 'flat.reeb'))
    await compare(join(work, 'flat.reeb'), () => [0])
  }
}

async function generated() {
  let files = 0
  for (let i = 0; i < 67; ++i) {
    const mesh = join(work, 'random.off')
    randomMesh(mesh)
    const options = [[], ['--buckets', '0'], ['--graph-only'], ['--buckets', '3']][i % 4]
    run('compute', mesh, '-f', 'x', '-f', 'y', '-f', 'z', '--quiet', '--force', '--threads', '1', ...options)
    for (const name of ['x', 'y', 'z']) {
      const file = join(work, `random-${name}.reeb`)
      const reader = await compare(file, ({ levels }) => {
        const chosen = [levels[random(levels.length)].threshold]
        return i % 8 === 0 ? [...chosen, 0] : [i % 2 ? 0 : chosen[0]]
      })
      if (i % 8 === 0) await comparePairs(file, reader)
      ++files
    }
  }
  return files
}

// The rims of the buckets of the full graph are the points of its lines on the surface.
async function compareRims(file) {
  const reader = await open(readFileSync(file))
  await reader.readTo(0)
  const { graph } = reader
  check(`${file}: buckets have rims`, graph.buckets > 20 && graph.bucketRim.length >= 3 * graph.buckets, graph.buckets)
  const points = new Set(
    run('extract', file, '--format', 'obj', '--on-surface').split('\n').filter((line) => line.startsWith('v '))
      .map((line) => line.split(' ').slice(1, 4).map(Number).join()),
  )
  let missing = 0
  for (let arc = 0; arc < graph.records; ++arc)
    for (let b = graph.firstBucket[arc]; graph.isIn(arc, 0) && b < graph.firstBucket[arc + 1]; ++b)
      if (!points.has([...graph.bucketRim.subarray(3 * b, 3 * b + 3)].join())) ++missing
  check(`${file}: rims`, missing === 0, `${missing} of ${graph.buckets} are not in the output of extract`)
}

async function refusal(bytes) {
  try {
    const reader = await open(bytes)
    await reader.readTo(0)
    if (reader.damage) return { text: reader.damage.message, finest: reader.graph.finest }
    for (let version = reader.graph.finest; version <= Math.min(1, reader.header.steps); ++version) reader.graph.contentOf(version)
    await reader.readPairs()
    return { text: '', finest: reader.graph.finest }
  } catch (error) {
    if (!(error instanceof FormatError)) throw error
    return { text: error.message, finest: null }
  }
}

async function damaged(name, bytes, places) {
  for (const at of places) {
    const flipped = bytes.slice()
    flipped[at] ^= 1 << random(8)
    check(`${name}: a flipped bit at byte ${at} is found`, (await refusal(flipped)).text !== '')
    check(`${name}: a file that was cut at byte ${at} is refused`, (await refusal(bytes.slice(0, at))).text !== '')
  }
}

const whole = example(source)
const file = join(work, 'example.reeb')
writeFileSync(file, whole)
await comparePairs(file, await compare(file, () => [0, 1, 2]))
await damaged('example', whole, whole.keys())

const scan = new Uint8Array(readFileSync(join(work, 'scan.reeb')))
const reader = await compare(join(work, 'scan.reeb'), ({ levels }) => levels.map(({ threshold }) => threshold))
check('the large file has several frames', reader.header.graphFrames > 2, reader.header.graphFrames)
await comparePairs(join(work, 'scan.reeb'), reader)
await compareRims(join(work, 'scan.reeb'))
for (const golden of ['reeb/version-1.reeb', 'reeb/version-2.reeb']) await compare(join(source, 'tests/golden', golden), () => [0, 1])
await damaged('scan', scan, Array.from({ length: 60 }, () => random(scan.length)))

// What was complete before the damage stays.
{
  const bytes = scan.slice(0, reader.header.levels.find(({ frames }) => frames > 1).fileBytes + 1000)
  const { text, finest } = await refusal(bytes)
  check('a cut file says where it ends', /was cut.*at byte/.test(text), text)
  check('a cut file has its coarse versions', finest > 0 && finest < reader.header.steps, finest)
}
// The budget holds, and pairs of the coarse part come without the rest.
{
  const coarse = await open(scan)
  check('the budget ends reading', (await coarse.readTo(0, 2000)) === 'budget')
  check('no more than the budget', coarse.graph.records <= 2000 && coarse.graph.records > 0, coarse.graph.records)
  const { lo, hi } = await coarse.readPairs()
  check('pairs of nodes that were read', lo.length > 0 && [...lo, ...hi].every((node) => node < coarse.graph.nodes), lo.length)
}

const refused = async (what, change, text) => {
  const bytes = whole.slice()
  change(bytes)
  const seen = await refusal(bytes)
  check(`${what}: what is said`, text.test(seen.text), seen.text)
}
await refused('another magic', (bytes) => (bytes[0] = 0x50), /not a \.reeb file/)
await refused('another version', (bytes) => (bytes[8] = 9), /version 9/)
await refused('a huge header', (bytes) => (bytes[20] = 1), /larger than the file/)
await refused('a wrong checksum', (bytes) => (bytes[60] ^= 1), /checksum/)
await refused('a damaged frame', (bytes) => (bytes[0x170] ^= 1), /frame is damaged/)

// Each rule, broken in the example, whose checksums are made right again.
{
  const { h64Raw } = await createRequire(join(packages, 'package.json'))('xxhash-wasm')()
  const sign = (bytes, at, ...parts) =>
    new DataView(bytes.buffer).setBigUint64(at, h64Raw(Uint8Array.from(parts.flatMap(([begin, end]) => [...bytes.subarray(begin, end)]))), true)
  const broken = (text, edits) =>
    refused(text, (bytes) => {
      for (const [at, ...written] of edits) bytes.set(written, at)
      sign(bytes, 0x121, [0, 0x121])
      sign(bytes, 0x149, [0x129, 0x149], [0x151, 0x1a1])
      sign(bytes, 0x1c1, [0x1a1, 0x1c1], [0x1c9, 0x1cf])
      sign(bytes, 0x1e7, [0x1cf, 0x1e7])
    }, new RegExp(`^${text}.* \\(at byte `))
  await broken('the header cannot have this size', [[0x10, 0x50, 0]])
  await broken('a file of version 2 has no embedding', [[8, 2]])
  await broken('the header has unknown flags', [[0x0c, 8]])
  await broken('a graph-only file has levels or pairs', [[0x0c, 1]])
  await broken('the range of the function is not finite', [[0x26, 0xf0, 0x7f]])
  await broken('the range of the function is empty', [[0x27, 0xc0]])
  await broken('a count is 2\\^53 or more', [[0x3f, 1]])
  await broken('the number of loops is wrong', [[0x50, 2]])
  await broken('there are too many cancellations', [[0x8c, 255, 255, 255, 255]])
  await broken('there are no frames', [[0x90, 0, 0, 0, 0, 0]])
  await broken('there are no levels', [[0x98, 0]])
  await broken('the name of the function is too long', [[0x9d, 0x11]])
  await broken('reserved bytes are not 0', [[0xa0, 1]])
  await broken('the sizes in the header do not add up', [[0x9c, 2]])
  await broken('a level is out of range', [[0xb1, 2]])
  await broken('a threshold is not a number', [[0xbf, 0xf8, 0x7f]])
  await broken('the levels are out of order', [[0xf8, 0x40]])
  await broken('the last level is not the full graph', [[0xb5, 0], [0xed, 0]])
  await broken('the last level has other counts than the graph', [[0xf9, 5]])
  await broken('the level table contradicts the frames', [[0xd9, 0xa2]])
  await broken('there are more nodes or arc records than the header says', [[0x58, 4]])
  await broken('the graph has other counts than the header says', [[0x58, 6]])
  await broken('there is no graph frame', [[0x129, 2]])
  await broken('a frame cannot have this size', [[0x12d, 0x51]])
  await broken('the file was cut: it ends in a frame', [[0x12d, 0, 255, 255, 0, 0, 255, 255]])
  await broken('a frame cannot be uncompressed', [[0x131, 0x60]])
  await broken('a frame has no room for what it says', [[0x139, 255, 255, 255, 127]])
  await broken('the versions of a frame do not continue those before', [[0x141, 1]])
  await broken('reserved bytes of a frame are not 0', [[0x145, 1]])
  await broken('the persistence of a version rises', [[0x160, 0x40]])
  await broken('version 0 has other counts than its frame says', [[0x162, 4]])
  await broken('the value of a node is not finite', [[0x17d, 0xf0], [0x181, 0xff]])
  await broken('a node is not above the one before it', [[0x17f, 0], [0x187, 1]])
  await broken('a node has a negative vertex', [[0x185, 1]])
  await broken('an arc dies before version 0', [[0x18f, 0x7f]])
  await broken('an arc dies after the last version', [[0x18a, 0xfd]])
  await broken('an arc is not born before it dies', [[0x193, 1]])
  await broken('an arc names a node that was not introduced', [[0x1a0, 4]])
  await broken('an arc does not go up', [[0x19d, 0]])
  await broken('arcs are out of order', [[0x198, 2, 1, 2]])
  await broken('a pairs frame has records or versions', [[0x1b1, 1]])
  await broken('a frame has bytes left over', [[0x1ad, 1]])
  await broken('a pair has an unknown type', [[0x1c9, 6]])
  await broken('a pair names a node that does not exist', [[0x1cb, 0x10]])
  await broken('the upper node of a pair is below its lower one', [[0x1cd, 1]])
  await broken('the number of pairs is not that of the header', [[0x60, 3]])
  await broken('the file was cut or is damaged: its end is missing', [[0x1d7, 0]])
}

// A path of 21 nodes whose arcs are 80 long, and a component of one arc that is as long.
async function marks() {
  const { roomsOf } = await bundled(source, 'drawing/shapes', packages, work)
  const lo = [...Array(20).keys(), 21]
  const ends = (list) => Uint32Array.from({ length: 23 }, (_, node) => list.filter((end) => end === node).length)
  const hi = lo.map((node) => node + 1)
  const content = { version: 0, nodes: 23, up: ends(lo), down: ends(hi) }
  const small = (scale, nodes = 23) => {
    const rooms = roomsOf({ lo, hi, isIn: () => true }, { ...content, nodes }, { length: new Float32Array(21).fill(80) })
    return [...rooms].map((room) => (room * scale < 1 ? 1 : 0)).join('')
  }
  check('arcs of 80 pixels have large marks', small(1) === '0'.repeat(23), small(1))
  check('a component of 39 pixels has small ones', small(39 / 80) === '0'.repeat(21) + '11', small(39 / 80))
  check('so have arcs of 7 pixels', small(7 / 80) === '1'.repeat(23), small(7 / 80))
  check('but not where there are few nodes', small(7 / 80, 20) === '0'.repeat(23), small(7 / 80, 20))
}

await marks()
await nearlyConstant()
const files = await generated()
console.log(failures === 0 ? `ok: ${files} generated files, the example and a scan` : `${failures} failures`)
process.exit(failures > 0 ? 1 : 0)

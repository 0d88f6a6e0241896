// The server of `reeb view`: what it answers, and what it refuses.
//
//   node view_server_test.mjs REEB WORK     WORK has scan.reeb
import { spawn, spawnSync } from 'node:child_process'
import { copyFileSync, readFileSync, rmSync, truncateSync } from 'node:fs'
import { connect } from 'node:net'
import { join } from 'node:path'

const [reeb, work] = process.argv.slice(2)
let failures = 0

function check(what, good, seen = '') {
  if (good) return console.log(`ok: ${what}`)
  console.log(`FAILED: ${what}: ${typeof seen === 'string' ? seen : JSON.stringify(seen)}`)
  ++failures
}

const environment = { ...process.env, DISPLAY: '', WAYLAND_DISPLAY: '' }

async function start(file, words = [], program = [reeb]) {
  const process = spawn(program[0], [...program.slice(1), 'view', file, ...words], { cwd: work, env: environment, stdio: ['ignore', 'pipe', 'ignore'] })
  let text = ''
  for await (const piece of process.stdout) {
    text += piece
    if (text.includes('\n')) break
  }
  const url = new URL(text.trim())
  const ended = new Promise((done) => process.once('exit', done))
  return { url, pid: process.pid, stop: (signal = 'SIGINT') => (process.kill(signal), ended) }
}

// What comes back for these bytes: the clients of Node.js would tidy up paths and headers.
function raw(port, text, { half = false } = {}) {
  return new Promise((done) => {
    const pieces = []
    const socket = connect(port, '127.0.0.1', () => (half ? socket.end(text) : socket.write(text)))
    socket.on('data', (piece) => pieces.push(piece))
    socket.on('error', () => {})
    socket.on('close', () => {
      const all = Buffer.concat(pieces)
      const end = all.indexOf('\r\n\r\n')
      const head = all.subarray(0, Math.max(0, end)).toString()
      done({ status: Number(head.split(' ')[1] ?? 0), head, body: all.subarray(end + 4) })
    })
  })
}
const get = (port, path, headers = [`Host: 127.0.0.1:${port}`], method = 'GET') =>
  raw(port, [`${method} ${path} HTTP/1.1`, ...headers, '', ''].join('\r\n'))

const bytes = readFileSync(join(work, 'scan.reeb'))
copyFileSync(join(work, 'scan.reeb'), join(work, 'two words%.reeb'))
const { url, stop } = await start('two words%.reeb')
const { port } = url
const host = `Host: 127.0.0.1:${port}`
const folder = url.pathname
const file = `${folder}two%20words%25.reeb`

check('the address is on this computer, with a random word', /^http:\/\/127\.0\.0\.1:\d+\/[0-9a-f]{32}\/$/.test(url.href), url.href)
const page = await get(port, folder)
const asked = new URL(/replaceState\(null, '', '([^']*)'/.exec(page.body)?.[1] ?? '', url)
check('the page asks for the file, whatever is in its name', new URL(asked.searchParams.get('file') ?? '', url).pathname === file, asked.href)
check('the page comes', page.status === 200 && page.body.includes('reeb viewer') && /text\/html/.test(page.head), page.head)
check('nothing may keep it, show it in a frame, or pass its address on', /no-store/.test(page.head) && /X-Frame-Options: DENY/.test(page.head) && /no-referrer/.test(page.head))
const whole = await get(port, file)
check('the file comes', whole.status === 200 && whole.body.equals(bytes), whole.head)
for (const [range, status, begin, end] of [
  ['bytes=0-9', 206, 0, 10],
  ['bytes=100-', 206, 100, bytes.length],
  ['bytes=-5', 206, bytes.length - 5, bytes.length],
  ['bytes=-99999999999999999999', 206, 0, bytes.length],
  ['bytes=7-99999999999999999999', 206, 7, bytes.length],
  [`bytes=${bytes.length - 1}-99999999999`, 206, bytes.length - 1, bytes.length],
  ['bytes=5-2', 200, 0, bytes.length],
  ['bytes=0-1,4-5', 200, 0, bytes.length],
  ['lines=0-1', 200, 0, bytes.length],
]) {
  const seen = await get(port, file, [host, `Range: ${range}`])
  const part = bytes.subarray(begin, end)
  const says = status === 200 || seen.head.includes(`Content-Range: bytes ${begin}-${end - 1}/${bytes.length}`)
  check(`range ${range}`, seen.status === status && seen.body.equals(part) && says, seen.head)
}
for (const begin of [bytes.length, '99999999999999999999'])
  check(`a range after the end, from ${begin}`, (await get(port, file, [host, `Range: bytes=${begin}-`])).status === 416)
const head = await get(port, file, [host], 'HEAD')
check('HEAD has no body', head.status === 200 && head.body.length === 0 && head.head.includes(`Content-Length: ${bytes.length}`), head.head)
for (const method of ['POST', 'PUT', 'DELETE', 'OPTIONS']) check(`${method} is refused`, (await get(port, file, [host], method)).status === 405)

for (const name of ['example.org', `example.org:${port}`, '127.0.0.1', '127.0.0.1:1', `[::1]:${port}`, `127.0.0.1:${port}.example.org`, ''])
  check(`the host "${name}" is refused`, (await get(port, file, [`Host: ${name}`])).status === 403)
check('no host is refused', (await get(port, file, [])).status === 403)
check('two hosts are refused', (await get(port, file, [host, 'Host: example.org'])).status === 403)
check('localhost is this computer', (await get(port, file, [`Host: localhost:${port}`])).status === 200)

const other = '0'.repeat(32)
for (const path of [
  '/', '/two%20words%25.reeb', `/${other}/`, `/${other}/two%20words%25.reeb`, folder.slice(0, -1), `${folder}scan.reeb`,
  `${folder}../scan.reeb`, `${folder}%2e%2e/scan.reeb`, `${folder}..%2fscan.reeb`, `${folder}./two%20words%25.reeb`,
  `${folder}/two%20words%25.reeb`, `${folder}${encodeURIComponent(join(work, 'scan.reeb'))}`, `${folder}two%20words%25.reeb%00`,
  `/${folder}two%20words%25.reeb`, `${folder}..%5cscan.reeb`, '/etc/passwd', `${folder}../../../../etc/passwd`,
  `http://127.0.0.1:${port}${file}`,
])
  check(`the path ${path} is refused`, (await get(port, path)).status === 404, String((await get(port, path)).status))
check('half an escape is no request', (await get(port, `${folder}%2`)).status === 400)
for (const text of ['\r\n\r\n', 'GET\r\n\r\n', 'GET / HTTP/9\r\n\r\n', '\x16\x03\x01\r\n\r\n'])
  check(`${JSON.stringify(text)} is no request`, (await raw(port, text)).status === 400)
check('a request that ends early gets no answer', (await raw(port, 'GET / HT', { half: true })).status === 0)
check('a request without end gets no answer', (await raw(port, `GET / HTTP/1.1\r\nX: ${'x'.repeat(40_000)}`)).status === 0)

const tabs = await Promise.all(Array.from({ length: 12 }, () => get(port, file)))
check('several at a time', tabs.every(({ body }) => body.equals(bytes)))
// More than are answered at a time, and all silent: they must not keep a stop from working.
const silent = Array.from({ length: 40 }, () => connect(port, '127.0.0.1').on('error', () => {}))

const second = spawnSync(reeb, ['view', 'scan.reeb', '--port', port], { cwd: work, env: environment, encoding: 'utf8' })
check('a port in use', second.status === 3 && second.stderr.includes(`port ${port} is in use`) && second.stderr.includes('hint: choose another --port'), second.stderr)
check('Ctrl-C ends it in good order', (await stop()) === 0)
for (const socket of silent) socket.destroy()

copyFileSync(join(work, 'scan.reeb'), join(work, 'gone.reeb'))
const again = await start('gone.reeb', ['--port', port])
check('the port that was asked for, again', again.url.port === port, again.url.href)
check('another run has another word', again.url.pathname !== folder)
rmSync(join(work, 'gone.reeb'))
check('a file that is removed meanwhile is still there', (await get(port, `${again.url.pathname}gone.reeb`)).body.equals(bytes))
check('SIGTERM ends it, too', (await again.stop('SIGTERM')) === 0)

copyFileSync(join(work, 'scan.reeb'), join(work, 'short.reeb'))
const short = await start('short.reeb')
truncateSync(join(work, 'short.reeb'), 1000)
const cut = await get(short.url.port, `${short.url.pathname}short.reeb`)
check('a file that becomes shorter: the connection ends early', cut.status === 200 && cut.body.length < bytes.length)
check('and the server goes on', (await get(short.url.port, short.url.pathname)).status === 200)
await short.stop()

// With 20 descriptors, most of these clients cannot be answered. They wait, and so does the server.
const few = await start('scan.reeb', [], ['bash', '-c', 'ulimit -n 20; exec "$@"', 'few', reeb])
const many = Array.from({ length: 30 }, () => connect(few.url.port, '127.0.0.1').on('error', () => {}))
await new Promise((done) => setTimeout(done, 1500))
const ticks = readFileSync(`/proc/${few.pid}/stat`, 'utf8').split(') ')[1].split(' ').slice(11, 13).map(Number)
check('a server without descriptors takes no processor time', ticks[0] + ticks[1] < 50, `${ticks} ticks of 10 ms`)
for (const socket of many) socket.destroy()
await few.stop()

const run = (...words) => spawnSync(reeb, ['view', ...words], { cwd: work, env: environment, encoding: 'utf8' })
check('no such file', run('none.reeb').status === 1 && /none\.reeb/.test(run('none.reeb').stderr), run('none.reeb').stderr)
check('a mesh is refused', run('scan.ply').status === 1, run('scan.ply').stderr)
for (const wrong of ['0', '65536', 'x', '-1']) check(`--port ${wrong} is refused`, run('scan.reeb', '--port', wrong).status === 2)
process.exit(failures > 0 ? 1 : 0)

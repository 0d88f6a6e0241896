// A server of one folder, with the faults that servers have: chosen by the first part of the path.
//
//   /good/NAME        ranges
//   /slow/NAME        ranges, 1 MB/s
//   /whole/NAME       no ranges
//   /cuts/NAME        ends each connection after 20,000 bytes
//   /gone/NAME        ends each connection at once
//   /hidden/NAME      ranges, for pages of other origins, but Content-Range stays hidden
//   /open/NAME        ranges, for pages of other origins
//   /key/NAME         ranges, only with the header `Authorization: key`
//   /busy/NAME        answers the first request for each range with HTTP 429
//   /flaky/NAME       ranges, or as /gone/ while `isDown` is set
import { readFileSync } from 'node:fs'
import { createServer } from 'node:http'
import { basename, join } from 'node:path'

export async function serve(folder) {
  const asked = []
  const state = { isDown: false }
  const server = createServer(async (request, response) => {
    const [, kind, name] = new URL(request.url, 'http://server').pathname.split('/')
    const range = /^bytes=(\d+)-(\d+)$/.exec(request.headers.range ?? '')
    const isFirst = !asked.some((before) => before.kind === kind && before.range === request.headers.range)
    asked.push({ kind, name, range: request.headers.range, method: request.method })
    if (kind === 'gone' || (kind === 'flaky' && state.isDown)) return request.socket.destroy()
    if (kind === 'busy' && isFirst) return response.writeHead(429).end()
    if (kind === 'key' && request.headers.authorization !== 'key') return response.writeHead(401).end()
    let bytes
    try {
      bytes = readFileSync(join(folder, basename(name)))
    } catch {
      return response.writeHead(404).end()
    }
    const headers = { 'Content-Type': name.endsWith('.html') ? 'text/html' : 'application/octet-stream' }
    if (kind === 'open' || kind === 'hidden') headers['Access-Control-Allow-Origin'] = '*'
    if (kind === 'open') headers['Access-Control-Expose-Headers'] = 'Content-Range'
    if (!range || kind === 'whole') return response.writeHead(200, { ...headers, 'Content-Length': bytes.length }).end(bytes)
    const begin = Number(range[1])
    const end = Math.min(Number(range[2]) + 1, bytes.length)
    if (begin >= end) return response.writeHead(416, headers).end()
    const part = bytes.subarray(begin, end)
    response.writeHead(206, { ...headers, 'Content-Length': part.length, 'Content-Range': `bytes ${begin}-${end - 1}/${bytes.length}` })
    if (kind === 'cuts' && part.length > 20_000) return response.write(part.subarray(0, 20_000), () => request.socket.end())
    if (kind !== 'slow') return response.end(part)
    for (let at = 0; at < part.length; at += 16_384) {
      await new Promise((done) => setTimeout(done, 16.384))
      response.write(part.subarray(at, at + 16_384))
    }
    response.end()
  })
  await new Promise((done) => server.listen(0, '127.0.0.1', done))
  return {
    asked,
    state,
    url: (path) => `http://127.0.0.1:${server.address().port}/${path}`,
    stop: () => {
      server.closeAllConnections()
      server.close()
    },
  }
}

// What the viewer's page does in a browser: levels as the file's table has them, selection, and what it says of servers
// and files that are not as they should be.
//
//   node viewer_test.mjs REEB WORK     WORK has scan.reeb, its scan.ply, many.reeb, parts.reeb and viewer.html
import { readFileSync, writeFileSync } from 'node:fs'
import { execFileSync } from 'node:child_process'
import { join } from 'node:path'
import { Browser, kColors, kPixels, pause } from './browser.mjs'
import { serve } from './file_server.mjs'

const [reeb, work] = process.argv.slice(2)
let failures = 0

function check(what, good, seen = '') {
  if (good) return console.log(`ok: ${what}`)
  console.log(`FAILED: ${what}: ${typeof seen === 'string' ? seen : JSON.stringify(seen)}`)
  ++failures
}

const server = await serve(work)
const elsewhere = await serve(work)
const browser = await Browser.start({ switches: ['--enable-unsafe-swiftshader'] })
// Waits between tries are shorter than for people, and handlers are timed.
await browser.send('Page.addScriptToEvaluateOnNewDocument', { source: `{
  window.spent = []
  const timed = (kind, run) => function (...words) {
    const begin = performance.now()
    run.apply(this, words)
    spent.push([kind, performance.now() - begin])
  }
  const [frame, timeout, add] = [requestAnimationFrame, setTimeout, EventTarget.prototype.addEventListener]
  window.requestAnimationFrame = (run) => frame(timed('frame', run))
  window.setTimeout = (run, wait) => timeout(timed('timeout', run), wait >= 500 ? wait / 10 : wait)
  EventTarget.prototype.addEventListener = function (type, run, options) {
    add.call(this, type, ['input', 'pointermove', 'keydown'].includes(type) ? timed(type, run) : run, options)
  }
  if (location.search.includes('undrawn'))
    for (const name of ['drawElements', 'drawArrays', 'drawElementsInstanced'])
      WebGL2RenderingContext.prototype[name] = () => {}
}` })

// Waits until an expression in the page is true; its last value.
async function until(expression, milliseconds = 15_000) {
  const end = Date.now() + milliseconds
  for (;;) {
    const value = await browser.evaluate(expression)
    if (value || Date.now() > end) return value
    await pause(30)
  }
}
const drawn = () => browser.evaluate(`(({ ...all }) => all)(document.getElementById('drawn').dataset)`)
const kIdle = `document.getElementById('drawn').dataset.reading === 'false'`
const message = () => browser.evaluate(`(({ hidden, textContent }) => (hidden ? '' : textContent))(document.getElementById('message'))`)

let visits = 0
let how = '' // 'undrawn': lines and points are not drawn
async function visit(query, options = { width: 400, height: 400 }) {
  await browser.open(server.url(`good/viewer.html?visit=${++visits}&${how}&file=${query}`), options)
}

async function refused(what, address, text) {
  await visit(encodeURIComponent(address))
  const seen = await until(`(({ hidden, textContent }) => (hidden ? '' : textContent))(document.getElementById('message'))`)
  check(`${what}: what is said`, text.test(seen), seen)
}

const { levels, graph, pairs } = JSON.parse(execFileSync(reeb, ['info', join(work, 'scan.reeb'), '--json'], { encoding: 'utf8' }))
await visit('/good/scan.reeb')
check('a picture comes', await until(kIdle), await message())
const colors = (id) => `(${kColors})(document.querySelector('#${id} canvas'))`
for (const id of ['space', 'flat']) check(`${id} is drawn`, await until(`${colors(id)} > 20`))
// A processor draws here, and others may use it: the limit of 300 ms is for people's machines.
const first = await browser.evaluate(`(([bytes, picture]) => picture.startTime - bytes.startTime)(['reeb-bytes', 'reeb-picture'].map((name) => performance.getEntriesByName(name)[0]))`)
check('the first picture comes early', first > 0 && first < 3000, first)
console.log(`first picture ${Math.round(first)} ms after its bytes`)
check('not all is loaded for it', Number((await drawn()).records) < 7000, await drawn())
check('the finest legible level is shown', Number((await drawn()).nodes) === levels.filter(({ nodes }) => nodes <= levels[0].nodes + 200).pop().nodes, await drawn())
const labels = await browser.evaluate(`[...document.querySelectorAll('#axis span')].map((label) => [Number(label.textContent), parseFloat(label.style.top)])`)
check('the graph has an axis of values', labels.length > 1 && labels.every(([value, top], i) => i === 0 || (value > labels[i - 1][0] && top < labels[i - 1][1])), labels)
await until(`document.querySelectorAll('[data-mark]').length > 0`)
const plots = await browser.evaluate(`[document.getElementById('plots-message').textContent, document.querySelector('#plot-diagram figcaption').textContent, document.querySelectorAll('[data-mark]').length]`)
check('one text says how many pairs are plotted', plots[0].startsWith(`Of ${pairs.toLocaleString('en')} pairs, `) && (plots[2] === 1000 || !/drawn, of/.test(plots[1])), plots)
for (const [i, level] of levels.entries()) {
  await browser.evaluate(`document.querySelector('[data-level="${i}"]').click()`)
  await until(`${kIdle} && document.getElementById('drawn').dataset.version === '${level.version}'`, 5000)
  const { nodes, arcs, version } = await drawn()
  check(`level ${i} has the nodes and arcs of the table`, Number(nodes) === level.nodes && Number(arcs) === level.arcs && Number(version) === level.version, { nodes, arcs, version, level })
}
check('loops of the full graph', Number((await drawn()).loops) === graph.loops, await drawn())
check('pairs come with the rest', await until(`document.querySelectorAll('[data-mark]').length > 900`))

// The pointer, fingers, and pictures.
const corner = JSON.parse(await browser.evaluate(`(() => {
  document.getElementById('space').scrollIntoView({ behavior: 'instant' })
  return JSON.stringify(document.getElementById('space').getBoundingClientRect())
})()`))
const inPicture = (x, y) => ({ x: corner.left + x * corner.width, y: corner.top + y * corner.height })
let label = ''
for (let i = 0; i < 100 && !label; ++i) {
  await browser.send('Input.dispatchMouseEvent', { type: 'mouseMoved', ...inPicture(0.3 + 0.04 * (i % 10), 0.3 + 0.04 * Math.floor(i / 10)) })
  label = await browser.evaluate(`new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => {
    const { hidden, textContent } = document.getElementById('tooltip')
    done(hidden ? '' : textContent)
  })))`)
}
check('hovering labels a node or an arc', /^(Minimum|Maximum|Fork) at vertex \d+\nvalue|^Arc from vertex \d+ to \d+\nvalues/.test(label), label)
const camera = () => until(`/[#&]view=([^&]*)/.exec(location.hash)?.[1]`).then((text) => text.split(',').map(Number))
const touch = (type, ...places) => browser.send('Input.dispatchTouchEvent', { type, touchPoints: places.map(([x, y], id) => ({ ...inPicture(x, y), id })) })
const untouched = await camera()
await touch('touchStart', [0.3, 0.5])
await touch('touchMove', [0.5, 0.5])
await touch('touchEnd')
await until(`!location.hash.includes('view=${untouched}')`)
const turned = await camera()
check('a finger rotates', turned[0] !== untouched[0] && turned[2] === untouched[2], [untouched, turned])
await touch('touchStart', [0.45, 0.5], [0.55, 0.5])
await touch('touchMove', [0.4, 0.5], [0.6, 0.5])
await touch('touchMove', [0.3, 0.5], [0.7, 0.5])
await touch('touchEnd')
// The address may have the camera of the first move before it has that of the last.
const zoomed = await until(`Number(/[#&]view=([^&]*)/.exec(location.hash)[1].split(',')[2]) > ${1.5 * turned[2]}`)
check('two fingers zoom', zoomed, [turned, await camera()])
const saved = JSON.parse(await browser.evaluate(`(() => {
  const pictures = []
  HTMLAnchorElement.prototype.click = function () { pictures.push([this.download, this.href.slice(0, 22), this.href.length]) }
  document.getElementById('picture').click()
  return JSON.stringify(pictures)
})()`))
check('pictures are saved', saved.length === 2 && saved.every(([name, head, size], i) =>
  name === `scan.reeb.${['space', 'flat'][i]}.png` && head === 'data:image/png;base64,' && size > 2000), saved)

// A mesh behind the skeleton.
const drop = (name, address, part = 'bytes') => browser.evaluate(`(async () => {
  const bytes = await (await fetch('${server.url(address)}')).arrayBuffer()
  const data = new DataTransfer()
  data.items.add(new File([${part}], '${name}'))
  dispatchEvent(new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true }))
})()`)
const painted = `(${kPixels})(document.querySelector('#space canvas')).filter((x, i) => i % 4 === 3 && x > 0).length`
const pixels = await browser.evaluate(painted)
const backdropName = `document.getElementById('backdrop-name').textContent`
await drop('torus.PLY', 'good/scan.ply')
check('a mesh that is dropped is named', await until(`/^torus.PLY, \\d[\\d,]* triangles$/.test(${backdropName})`), await message())
check('and drawn', await until(`${painted} > ${1.2 * pixels}`), [pixels, await browser.evaluate(painted)])
for (const [part, text] of [[`'ply, but not more'`, /damaged|no triangles/], ['bytes.slice(0, 9000)', /damaged|not there|no triangles/], [`'OFF'`, /not a PLY file/]]) {
  await drop('bad.ply', 'good/scan.ply', part)
  check(`a mesh like ${part} is refused`, await until(`${text}.test(document.getElementById('message').textContent)`), await message())
}
check('the mesh before stays', /^torus/.test(await browser.evaluate(backdropName)))
await browser.evaluate(`document.getElementById('no-backdrop').click()`)
check('it can be removed', (await browser.evaluate(backdropName)) === '' && (await until(`${painted} < ${1.1 * pixels}`)))

// Each mark chooses the feature that it describes.
for (const i of [0, 5]) {
  const said = await browser.evaluate(`(() => {
    const mark = document.querySelector('[data-mark="${i}"]')
    mark.dispatchEvent(new MouseEvent('click', { bubbles: true }))
    return [mark.querySelector('title').textContent, document.getElementById('chosen').textContent, mark.classList.contains('chosen')]
  })()`)
  const persistence = /persistence (\S+)$/.exec(said[0])[1]
  check(`mark ${i} lights up`, said[1].includes(`persistence ${persistence}`) && said[2], said)
}
check('the choice is in the address', await until(`/[&#]at=\\d+,\\d+/.test(location.hash)`))
await browser.press('Escape')
await browser.evaluate(`dispatchEvent(new KeyboardEvent('keydown', { key: 'Escape' }))`)
check('Escape ends the choice', await browser.evaluate(`document.getElementById('chosen').textContent === ''`))

// The slider.
await browser.evaluate(`(() => { const level = document.getElementById('level'); level.value = 1000; level.dispatchEvent(new Event('input')) })()`)
check('the slider coarsens', Number((await drawn()).nodes) === 2, await drawn())
await browser.evaluate(`document.getElementById('level').focus()`)
await browser.press('ArrowLeft')
check('the keyboard moves the slider', await browser.evaluate(`document.getElementById('level').value === '999'`))
for (const coloring of ['arc', 'type']) {
  await browser.evaluate(`(() => { const input = document.getElementById('coloring'); input.value = '${coloring}'; input.dispatchEvent(new Event('change')) })()`)
  check(`colours by ${coloring}`, await until(`location.hash.includes('colour=${coloring}')`))
}
await browser.evaluate(`(() => { const input = document.getElementById('threshold'); input.value = '1%'; input.dispatchEvent(new Event('change')) })()`)
await until(`/[#&]t=0\\.63/.test(location.hash)`)
const before = await drawn()
const extracted = execFileSync(reeb, ['extract', join(work, 'scan.reeb'), '--threshold', '1%'], { encoding: 'utf8' })
check('a threshold has the arcs of extract', extracted.split('\n').filter((line) => line.startsWith('a ')).length === Number(before.arcs), before)
const hash = await browser.evaluate('location.hash')
check('no complaint in the console', browser.complaints().length === 0, browser.complaints())
await visit(`/good/scan.reeb${hash}`, { dark: true, width: 700 })
await until(`${kIdle} && document.getElementById('drawn').dataset.nodes === '${before.nodes}'`)
const after = await drawn()
check('the address brings the view back', after.nodes === before.nodes && (await browser.evaluate(`document.getElementById('coloring').value`)) === 'type', after)
check('a narrow window is not wider', (await browser.evaluate(`document.documentElement.scrollWidth - innerWidth`)) <= 0)
const unnamed = await browser.evaluate(`[...document.querySelectorAll('button, input, select, textarea')].filter((element) => !(element.textContent.trim() ||
  element.getAttribute('aria-label') || element.labels?.length)).map((element) => element.id)`)
check('everything has a name', unnamed.length === 0, unnamed)

// What follows is about reading and words. A processor that draws takes longer for the rest.
how = 'undrawn'

// The budget.
await visit('/good/scan.reeb#arcs=2000&t=0')
await until(kIdle)
const limited = await drawn()
check('the budget is kept', Number(limited.records) <= 2000 && Number(limited.finest) > 0, limited)
check('and said', await until(`/budget is reached/.test(document.getElementById('loaded').textContent)`))

// A hundred thousand arcs. Only the script is timed here: a processor that draws, too, has other frames. The limit for
// people's machines is 8 ms; others may use this one.
await visit('/good/many.reeb#t=0')
await until(`${kIdle} && document.getElementById('drawn').dataset.version === '0' && document.querySelectorAll('[data-mark]').length > 0`, 30_000)
check('there are many arcs', Number((await drawn()).records) > 100_000, await drawn())
await pause(500)
await browser.evaluate('spent.length = 0')
for (let i = 0; i < 12; ++i) {
  await browser.evaluate(`(() => { const level = document.getElementById('level'); level.value = ${900 - 50 * i}; level.dispatchEvent(new Event('input')) })()`)
  await browser.evaluate(`document.getElementById('space').dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowLeft' }))`)
  await browser.evaluate(`document.getElementById('space').dispatchEvent(new PointerEvent('pointermove', { clientX: 60 + 9 * ${i}, clientY: 150 }))`)
  await browser.evaluate('new Promise((done) => requestAnimationFrame(done))')
}
await pause(600)
const spent = JSON.parse(await browser.evaluate('JSON.stringify(spent)'))
for (const kind of ['input', 'keydown', 'pointermove', 'frame', 'timeout']) {
  const times = spent.filter(([of]) => of === kind).map(([, time]) => time).sort((a, b) => a - b)
  const [median, most] = [times[times.length >> 1], times[times.length - 1]]
  console.log(`script of ${kind} with 100,000 arcs: ${median?.toFixed(1)} ms, at most ${most?.toFixed(1)} ms`)
  check(`${kind} takes little time`, times.length > 0 && median < 60, times)
}

// Files of the user.
const dropped = (part) => drop('dropped.reeb', 'good/scan.reeb', part)
await dropped('bytes')
check('a file that is dropped is shown', await until(`document.getElementById('name').textContent === 'dropped.reeb' && ${kIdle}`))
await dropped(`bytes.slice(0, 120000)`)
check('a cut file says so', await until(`/was cut|end is missing/.test(document.getElementById('message').textContent)`), await message())
check('and shows what it has', Number((await drawn()).nodes) > 1, await drawn())
await dropped(`'not a graph'`)
check('another file is refused', await until(`/not a \\.reeb file/.test(document.getElementById('message').textContent)`), await message())

// Servers.
await visit('/good/parts.reeb')
check('many components leave a level its features', (await until(`${kIdle} && document.getElementById('drawn').dataset.nodes`)) && Number((await drawn()).nodes) === 361, await drawn())
await visit('/slow/scan.reeb')
check('a slow server: a picture comes before all is loaded', (await until(`Number(document.getElementById('drawn').dataset.nodes) > 0`)) && (await drawn()).loaded < 290_000, await drawn())
await visit('/cuts/scan.reeb#t=0')
check('a server that cuts connections: the page asks again', (await until(`document.getElementById('drawn').dataset.version === '0'`)) !== false, await message())
await visit(encodeURIComponent(elsewhere.url('open/scan.reeb')))
check('another origin that allows it', await until(kIdle), await message())
await refused('no ranges', '/whole/scan.reeb', /sends whole files only.*\(HTTP 200 instead of 206\)/)
await refused('no such file', '/good/none.reeb', /no such file \(HTTP 404\)/)
await refused('another origin without CORS', elsewhere.url('good/scan.reeb'), /does not allow other pages.*\(CORS\)/)
await refused('a hidden Content-Range', elsewhere.url('hidden/scan.reeb'), /hides Content-Range/)
await refused('a server that does not answer', '/gone/scan.reeb', /does not answer.*tries failed/)
await refused('no access', '/key/scan.reeb', /refuses access \(HTTP 401\)/)
await browser.evaluate(`(() => {
  document.getElementById('headers').value = 'Authorization: key'
  document.getElementById('fetch').requestSubmit()
})()`)
check('with a header there is access', await until(`${kIdle} && document.getElementById('message').hidden`), await message())
if (process.env.REEB_SCREENSHOT) writeFileSync(process.env.REEB_SCREENSHOT, await browser.screenshot())

await browser.stop()
server.stop()
elsewhere.stop()

// A browser without WebGL still has the plots and levels.
const plain = await Browser.start({ switches: ['--disable-gpu', '--disable-3d-apis'] })
const last = await serve(work)
await plain.open(last.url('good/viewer.html?file=/good/scan.reeb'))
let said = ''
for (let i = 0; i < 200 && !/no WebGL/.test(said); ++i) {
  await pause(30)
  said = await plain.evaluate(`document.getElementById('message').textContent`)
}
check('without WebGL it says so', /no WebGL/.test(said), said)
for (let i = 0; i < 200 && !(await plain.evaluate(`document.querySelectorAll('[data-mark]').length > 0`)); ++i) await pause(30)
check('without WebGL there are plots', await plain.evaluate(`document.querySelectorAll('[data-mark]').length > 0`))
await plain.stop()
last.stop()
process.exit(failures > 0 ? 1 : 0)

// What the viewer's page does in a browser: levels as the file's table has them, selection, and what it says of servers
// and files that are not as they should be.
//
//   node viewer_test.mjs REEB WORK     WORK has scan.reeb and viewer.html
import { readFileSync, writeFileSync } from 'node:fs'
import { execFileSync } from 'node:child_process'
import { join } from 'node:path'
import { Browser, pause } from './browser.mjs'
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
async function visit(query, options = { width: 640, height: 480 }) {
  await browser.open(server.url(`good/viewer.html?visit=${++visits}&file=${query}`), options)
}

async function refused(what, address, text) {
  await visit(encodeURIComponent(address))
  const seen = await until(`(({ hidden, textContent }) => (hidden ? '' : textContent))(document.getElementById('message'))`)
  check(`${what}: what is said`, text.test(seen), seen)
}

const { levels, graph } = JSON.parse(execFileSync(reeb, ['info', join(work, 'scan.reeb'), '--json'], { encoding: 'utf8' }))
await visit('/good/scan.reeb')
check('a picture comes', await until(kIdle), await message())
const colors = (id) => `(() => {
  const drawn = document.querySelector('#${id} canvas')
  const canvas = document.createElement('canvas')
  canvas.width = drawn.width
  canvas.height = drawn.height
  const context = canvas.getContext('2d')
  context.drawImage(drawn, 0, 0)
  return new Set(new Uint32Array(context.getImageData(0, 0, canvas.width, canvas.height).data.buffer)).size
})()`
for (const id of ['space', 'flat']) check(`${id} is drawn`, await until(`${colors(id)} > 20`))
// A processor draws here, and others may use it: the limit of 300 ms is for people's machines.
const first = Number((await drawn()).first)
check('the first picture comes early', first < 3000, first)
console.log(`first picture after ${first} ms`)
check('not all is loaded for it', Number((await drawn()).records) < 7000, await drawn())
check('the finest legible level is shown', Number((await drawn()).nodes) === levels.filter(({ nodes }) => nodes <= 200).pop().nodes, await drawn())
for (const [i, level] of levels.entries()) {
  await browser.evaluate(`document.querySelector('[data-level="${i}"]').click()`)
  await until(`${kIdle} && document.getElementById('drawn').dataset.version === '${level.version}'`, 5000)
  const { nodes, arcs, version } = await drawn()
  check(`level ${i} has the nodes and arcs of the table`, Number(nodes) === level.nodes && Number(arcs) === level.arcs && Number(version) === level.version, { nodes, arcs, version, level })
}
check('loops of the full graph', Number((await drawn()).loops) === graph.loops, await drawn())
check('pairs come with the rest', await until(`document.querySelectorAll('[data-mark]').length > 900`))

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
await until(kIdle)
const after = await drawn()
check('the address brings the view back', after.nodes === before.nodes && (await browser.evaluate(`document.getElementById('coloring').value`)) === 'type', after)
check('a narrow window is not wider', (await browser.evaluate(`document.documentElement.scrollWidth - innerWidth`)) <= 0)
const unnamed = await browser.evaluate(`[...document.querySelectorAll('button, input, select, textarea')].filter((element) => !(element.textContent.trim() ||
  element.getAttribute('aria-label') || element.labels?.length)).map((element) => element.id)`)
check('everything has a name', unnamed.length === 0, unnamed)

// The budget.
await visit('/good/scan.reeb#arcs=2000&t=0')
await until(kIdle)
const limited = await drawn()
check('the budget is kept', Number(limited.records) <= 2000 && Number(limited.finest) > 0, limited)
check('and said', /budget is reached/.test(await browser.evaluate(`document.getElementById('loaded').textContent`)))

// Files of the user.
const dropped = (bytes) => browser.evaluate(`(async () => {
  const bytes = await (await fetch('${server.url('good/scan.reeb')}')).arrayBuffer()
  const data = new DataTransfer()
  data.items.add(new File([${bytes}], 'dropped.reeb'))
  dispatchEvent(new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true }))
})()`)
await dropped('bytes')
check('a file that is dropped is shown', await until(`document.getElementById('name').textContent === 'dropped.reeb' && ${kIdle}`))
await dropped(`bytes.slice(0, 120000)`)
check('a cut file says so', await until(`/was cut|end is missing/.test(document.getElementById('message').textContent)`), await message())
check('and shows what it has', Number((await drawn()).nodes) > 1, await drawn())
await dropped(`'not a graph'`)
check('another file is refused', await until(`/not a \\.reeb file/.test(document.getElementById('message').textContent)`), await message())

// Servers.
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

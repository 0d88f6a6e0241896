// A headless Chromium, driven through its debugging pipe: nothing but Node.js is needed.
import { spawn } from 'node:child_process'
import { mkdtempSync, rmSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { join } from 'node:path'

const kMostMilliseconds = 60_000 // of one answer, on a machine that is busy

export class Browser {
  static async start({ program = 'chromium', switches = [] } = {}) {
    const browser = new Browser()
    browser.folder = mkdtempSync(join(tmpdir(), 'chromium-'))
    browser.process = spawn(
      program,
      [
        '--headless=new', '--no-sandbox', '--remote-debugging-pipe', `--user-data-dir=${browser.folder}`,
        '--disable-background-networking', '--disable-dev-shm-usage', '--no-first-run', '--hide-scrollbars', ...switches,
      ],
      { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'] },
    )
    browser.next = 1
    browser.waiting = new Map()
    browser.events = []
    let rest = ''
    browser.process.stdio[4].on('data', (bytes) => {
      rest += bytes
      const messages = rest.split('\0')
      rest = messages.pop()
      for (const message of messages) browser.receive(JSON.parse(message))
    })
    const { targetId } = await browser.send('Target.createTarget', { url: 'about:blank' })
    const { sessionId } = await browser.send('Target.attachToTarget', { targetId, flatten: true })
    browser.session = sessionId
    for (const domain of ['Page', 'Runtime', 'Log', 'Network']) await browser.send(`${domain}.enable`)
    return browser
  }

  receive(message) {
    const waiting = this.waiting.get(message.id)
    if (!waiting) return this.events.push(message)
    this.waiting.delete(message.id)
    if (message.error) waiting.reject(new Error(message.error.message))
    else waiting.resolve(message.result)
  }

  send(method, params = {}) {
    const id = this.next++
    this.process.stdio[3].write(JSON.stringify({ id, method, params, sessionId: this.session }) + '\0')
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve, reject })
      const silent = () => reject(new Error(`the browser does not answer ${method} within ${kMostMilliseconds} ms`))
      setTimeout(silent, kMostMilliseconds).unref()
    })
  }

  resize({ width, height, scale }) {
    return this.send('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: scale, mobile: false })
  }

  async open(url, { width = 1280, height = 900, scale = 1, dark = false } = {}) {
    this.events = []
    await this.resize({ width, height, scale })
    const features = [{ name: 'prefers-color-scheme', value: dark ? 'dark' : 'light' }]
    await this.send('Emulation.setEmulatedMedia', { features })
    await this.send('Page.navigate', { url })
    const end = Date.now() + kMostMilliseconds
    while (!this.events.some(({ method }) => method === 'Page.loadEventFired')) {
      if (Date.now() > end) throw new Error(`${url} is not loaded within ${kMostMilliseconds} ms`)
      await pause(20)
    }
    await this.evaluate('new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))')
  }

  // The value of an expression in the page; of a promise, what it becomes.
  async evaluate(expression) {
    const { result, exceptionDetails } = await this.send('Runtime.evaluate', {
      expression, returnByValue: true, awaitPromise: true,
    })
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text)
    return result.value
  }

  async press(key) {
    for (const type of ['keyDown', 'keyUp']) await this.send('Input.dispatchKeyEvent', { type, key, code: key, windowsVirtualKeyCode: { ArrowLeft: 37, ArrowRight: 39, Enter: 13, Tab: 9, Escape: 27 }[key] ?? 0, ...(key === 'Enter' && type === 'keyDown' ? { text: '\r' } : {}) })
  }

  // Errors and warnings of the page, and what it asked of the network.
  complaints() {
    return this.events.flatMap(({ method, params }) => {
      if (method === 'Runtime.exceptionThrown') return [params.exceptionDetails.exception?.description ?? params.exceptionDetails.text]
      if (method === 'Runtime.consoleAPICalled' && ['error', 'warning', 'assert'].includes(params.type))
        return [params.args.map((arg) => arg.value ?? arg.description).join(' ')]
      if (method === 'Log.entryAdded' && params.entry.level === 'error') return [params.entry.text]
      return []
    })
  }

  requests() {
    return this.events
      .filter(({ method }) => method === 'Network.requestWillBeSent')
      .map(({ params }) => params.request.url)
      .filter((url) => !/^(file|data|blob):/.test(url))
  }

  async screenshot(options = {}) {
    return Buffer.from((await this.send('Page.captureScreenshot', { captureBeyondViewport: true, ...options })).data, 'base64')
  }

  async pdf() {
    return Buffer.from((await this.send('Page.printToPDF', { preferCSSPageSize: true })).data, 'base64')
  }

  async stop() {
    const ended = new Promise((done) => this.process.once('exit', done))
    this.session = undefined
    this.send('Browser.close').catch(() => {})
    await Promise.race([ended, pause(5000)])
    this.process.kill('SIGKILL')
    rmSync(this.folder, { recursive: true, force: true, maxRetries: 5, retryDelay: 100 })
  }
}

export function pause(milliseconds) {
  return new Promise((done) => setTimeout(done, milliseconds))
}

// Functions for the page. What a canvas shows: its pixels, four bytes each; how many colours, which is one if it is empty.
export const kPixels = `(canvas) => {
  const copy = document.createElement('canvas')
  ;[copy.width, copy.height] = [canvas.width, canvas.height]
  const context = copy.getContext('2d')
  context.drawImage(canvas, 0, 0)
  return context.getImageData(0, 0, copy.width, copy.height).data
}`
export const kColors = `(canvas) => new Set(new Uint32Array((${kPixels})(canvas).buffer)).size`

// Where the bytes of a file come from: a file of the user, or a server.

export interface Source {
  readonly name: string
  readonly size: number // known after the first read
  readonly loaded: number // bytes that were read so far
  // The bytes from `begin` to `end`, or to the end of the file.
  read(begin: number, end: number): Promise<Uint8Array>
  stop(): void
}

// A source that does not deliver: what is wrong, and what the user can do.
export class SourceError extends Error {
  constructor(what: string, readonly hint: string) {
    super(what)
  }
}

export class BlobSource implements Source {
  loaded = 0

  constructor(private readonly blob: Blob, readonly name: string) {}

  get size() {
    return this.blob.size
  }

  async read(begin: number, end: number) {
    try {
      const bytes = new Uint8Array(await this.blob.slice(begin, end).arrayBuffer())
      this.loaded += bytes.length
      return bytes
    } catch {
      throw new SourceError('The file cannot be read any more.', 'It may have been changed, moved or deleted: drop it here again.')
    }
  }

  stop() {}
}

const kTries = 4
const kLeastBytes = 4096
const kDownload = 'Download the file, and drop it onto this page.'

export class HttpSource implements Source {
  size = NaN
  loaded = 0
  readonly name: string
  readonly url: URL
  private readonly abort = new AbortController()
  private tag: string | null = null
  private most = Infinity // bytes of a request: fewer where connections are cut

  // `address`: may be relative to that of the page. `progress` is called while bytes come in, `retrying` before each
  // further try. THROWS if it is no address.
  constructor(
    readonly address: string,
    private readonly headers: [string, string][],
    private readonly report: { progress?: () => void; retrying?: (what: string) => void } = {},
    private readonly waitMilliseconds = 500,
  ) {
    this.url = new URL(address, globalThis.location?.href)
    if (address === '' || !/^https?:$/.test(this.url.protocol))
      throw new SourceError(`"${address}" is not the address of a file on a server.`, 'Drop a file of this computer onto this page.')
    this.name = decoded(this.url.pathname.split('/').pop() ?? '') || address
  }

  async read(begin: number, end: number): Promise<Uint8Array> {
    const parts: Uint8Array[] = []
    let at = begin
    for (let tries = 1; ; ++tries) {
      try {
        await this.request(at, Math.min(end, at + this.most), (part) => {
          parts.push(part)
          at += part.length
          this.loaded += part.length
          tries = 1
          this.report.progress?.()
        })
        if (at >= Math.min(end, this.size)) break
      } catch (error) {
        if (!(error instanceof Interrupted)) throw error
        if (error.isCut) this.most = Math.max(kLeastBytes, Math.min(this.most, end - at) / 2) | 0
        if (tries >= kTries) throw new SourceError(`${error.message} ${kTries} tries failed.`, 'Check the network, and try again.')
        this.report.retrying?.(error.message)
        await new Promise((done) => setTimeout(done, this.waitMilliseconds * 2 ** (tries - 1)))
        if (this.abort.signal.aborted) throw new DOMException('stopped', 'AbortError')
      }
    }
    const all = new Uint8Array(at - begin)
    let offset = 0
    for (const part of parts) {
      all.set(part, offset)
      offset += part.length
    }
    return all
  }

  stop() {
    this.abort.abort()
  }

  private async request(begin: number, end: number, take: (part: Uint8Array) => void) {
    const once = new AbortController()
    const stop = () => once.abort()
    this.abort.signal.addEventListener('abort', stop)
    try {
      const headers = new Headers(this.headers)
      headers.set('Range', `bytes=${begin}-${end - 1}`)
      const response = await fetch(this.url, { headers, signal: once.signal, cache: 'no-store' }).catch((error) =>
        this.explain(error),
      )
      const room = this.check(response, begin, end)
      const reader = response.body!.getReader()
      for (let left = room; left > 0; ) {
        const { done, value } = await reader.read().catch((error) => {
          if (this.abort.signal.aborted) throw error
          throw new Interrupted('The connection was cut.', true)
        })
        if (done) throw new Interrupted('The connection ended early.', true)
        take(value.subarray(0, left))
        left -= value.length
      }
    } finally {
      this.abort.signal.removeEventListener('abort', stop)
      once.abort() // of what is not wanted
    }
  }

  // How many bytes the answer has. THROWS: SourceError.
  private check(response: Response, begin: number, end: number): number {
    const { status } = response
    if (status === 200)
      throw new SourceError('The server sends whole files only: it ignores requests for parts (HTTP 200 instead of 206).', kDownload)
    if (status === 401 || status === 403)
      throw new SourceError(`The server refuses access (HTTP ${status}).`, 'Set a header for it, such as Authorization.')
    if (status === 404 || status === 410)
      throw new SourceError(`The server has no such file (HTTP ${status}).`, 'Check the address.')
    if (status === 416) throw new SourceError('The file is empty or has become shorter (HTTP 416).', 'Open it again.')
    if (status === 429 || status >= 500) throw new Interrupted(`The server has a problem (HTTP ${status}).`)
    if (status !== 206) throw new SourceError(`The server answers with HTTP ${status} instead of 206.`, kDownload)
    const text = response.headers.get('Content-Range')
    if (text === null)
      throw new SourceError(
        'The server hides Content-Range, so the page cannot see which part of the file it got.',
        'The server must send "Access-Control-Expose-Headers: Content-Range".',
      )
    const match = /^bytes (\d+)-(\d+)\/(\d+)$/.exec(text.trim())
    if (!match) throw new SourceError(`The server describes its answer as "${text}", which has no size of the file.`, kDownload)
    const [first, last, size] = match.slice(1).map(Number)
    if (first !== begin || last >= Math.max(end, 1) || last >= size || last < first)
      throw new SourceError(`The server sends another part of the file than was asked for: ${text}.`, kDownload)
    const tag = response.headers.get('ETag') ?? response.headers.get('Last-Modified')
    if ((!Number.isNaN(this.size) && size !== this.size) || (this.tag !== null && tag !== null && tag !== this.tag))
      throw new SourceError('The file on the server has changed meanwhile.', 'Open it again.')
    this.size = size
    this.tag = tag
    return last - first + 1
  }

  // Browsers do not say why a request failed; a request whose answer stays hidden tells a server that forbids reading
  // from one that does not answer.
  private async explain(error: Error): Promise<never> {
    if (this.abort.signal.aborted) throw error
    const foreign = globalThis.location !== undefined && this.url.origin !== globalThis.location.origin
    const answers =
      foreign &&
      (await fetch(this.url, { mode: 'no-cors', method: 'HEAD', cache: 'no-store' }).then(
        () => true,
        () => false,
      ))
    if (answers)
      throw new SourceError(
        'The server answers, but does not allow other pages to read its files (CORS).',
        'The server must send "Access-Control-Allow-Origin: *" and allow the headers Range and those that you set. Or download the file, and drop it onto this page.',
      )
    throw new Interrupted('The server does not answer.')
  }
}

// A name in which % begins no escape stays as it is.
function decoded(name: string): string {
  try {
    return decodeURIComponent(name)
  } catch {
    return name
  }
}

// A failure after which another try can help: in smaller parts, if the connection was cut.
class Interrupted extends Error {
  constructor(what: string, readonly isCut = false) {
    super(what)
  }
}

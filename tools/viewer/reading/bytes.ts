// Numbers as a .reeb file has them.

// The file breaks a rule of docs/FORMAT.md: which, and at which byte.
export class FormatError extends Error {
  constructor(what: string, readonly offset: number) {
    super(`${what} (at byte ${offset.toLocaleString('en')})`)
  }
}

// The number whose zigzag code this is.
const half = (zigzag: number) => (zigzag % 2 === 0 ? zigzag / 2 : -(zigzag + 1) / 2)

// Reads from the start of `bytes`, whose first byte is byte `origin` of the file.
export class Cursor {
  private at = 0
  private readonly view: DataView

  constructor(readonly bytes: Uint8Array, readonly origin: number) {
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength)
  }

  get offset() {
    return this.origin + this.at
  }

  get left() {
    return this.bytes.length - this.at
  }

  fail(what: string): never {
    throw new FormatError(what, this.offset)
  }

  take(size: number): Uint8Array {
    if (size > this.left) this.fail('it ends too early')
    this.at += size
    return this.bytes.subarray(this.at - size, this.at)
  }

  u32(): number {
    this.take(4)
    return this.view.getUint32(this.at - 4, true)
  }

  i32(): number {
    return this.u32() | 0
  }

  digest(): bigint {
    this.take(8)
    return this.view.getBigUint64(this.at - 8, true)
  }

  // Numbers of JavaScript are exact up to 2^53.
  u64(): number {
    const value = Number(this.digest())
    if (!Number.isSafeInteger(value)) this.fail('a count is 2^53 or more')
    return value
  }

  f64(): number {
    this.take(8)
    return this.view.getFloat64(this.at - 8, true)
  }

  varint(): number {
    const value = this.rounded()
    if (!Number.isSafeInteger(value)) this.fail('a number is 2^53 or more')
    return value
  }

  // b + (a - b). Buckets of a function that is nearly constant have indices of up to 2^53, of which the code is twice as
  // large.
  delta(before: number): number {
    const start = this.at
    const zigzag = this.rounded()
    const value = before + (Number.isSafeInteger(zigzag) ? half(zigzag) : this.longHalf(start))
    if (Math.abs(value) > 2 ** 53) this.fail('a number is beyond 2^53')
    return value
  }

  // A varint, rounded where it has more than 53 bits.
  private rounded(): number {
    let value = 0
    let scale = 1
    for (let i = 0; i < 10; ++i) {
      if (this.at >= this.bytes.length) this.fail('it ends too early')
      const byte = this.bytes[this.at++]
      value += (byte & 127) * scale
      if (byte < 128) return value
      scale *= 128
    }
    this.fail('a number has more than 64 bits')
  }

  // half() of the varint from there to here.
  private longHalf(start: number): number {
    let zigzag = 0n
    for (let i = this.at - 1; i >= start; --i) zigzag = zigzag * 128n + BigInt(this.bytes[i] & 127)
    return Number(zigzag % 2n === 0n ? zigzag / 2n : -(zigzag + 1n) / 2n)
  }

  // n numbers of 64 bits, each as its lower and its upper half.
  planes(n: number): Uint32Array {
    const planes = this.take(8 * n)
    const halves = new Uint32Array(2 * n)
    for (let i = 0; i < n; ++i)
      for (let half = 0; half < 2; ++half) {
        const first = 4 * half * n + i
        halves[2 * i + half] =
          planes[first] | (planes[first + n] << 8) | (planes[first + 2 * n] << 16) | (planes[first + 3 * n] << 24)
      }
    return halves
  }

  floats(n: number): Float64Array {
    return new Float64Array(this.planes(n).buffer)
  }

  // Values as differences of ordered(value).
  values(n: number): Float64Array {
    const halves = this.planes(n)
    let [low, high] = [0, 0]
    for (let i = 0; i < 2 * n; i += 2) {
      const sum = low + halves[i]
      low = sum >>> 0
      high = (high + halves[i + 1] + (sum > low ? 1 : 0)) >>> 0
      const negative = high < 0x80000000
      halves[i] = negative ? ~low : low
      halves[i + 1] = negative ? ~high : high & 0x7fffffff
    }
    return new Float64Array(halves.buffer)
  }
}

// The data of the page: what tools/report writes, decoded.

export function readData() {
  return JSON.parse(document.getElementById('data').textContent)
}

// Numbers of 16 bits, low byte first.
export function numbers16(base64) {
  const bytes = atob(base64)
  const numbers = new Uint16Array(bytes.length / 2)
  for (let i = 0; i < numbers.length; ++i) numbers[i] = bytes.charCodeAt(2 * i) | (bytes.charCodeAt(2 * i + 1) << 8)
  return numbers
}

const kDigits = 6 // are enough for people
const kAllDigits = 17

export function shortNumber(value, digits = kDigits) {
  if (value === 0) return '0'
  const size = Math.abs(value)
  if (size < 1e-4 || size >= 1e6) return value.toExponential(digits - 2).replace(/\.?0+e/, 'e')
  return String(Number(value.toPrecision(digits)))
}

// Texts of different numbers, with as many digits as tell them apart.
export function distinctNumbers(values) {
  const different = new Set(values).size
  for (let digits = kDigits; ; ++digits) {
    const texts = values.map((value) => shortNumber(value, digits))
    if (new Set(texts).size === different || digits > kAllDigits) return texts
  }
}

export function count(number, noun) {
  return `${number.toLocaleString('en')} ${noun}${number === 1 ? '' : 's'}`
}

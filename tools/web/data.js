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

// How many digits tell numbers of this range apart, even if it is small beside them.
export function digitsFor(min, max) {
  const most = Math.max(Math.abs(min), Math.abs(max)) / 2
  const range = max / 2 - min / 2
  return range > 0 && range < most ? Math.min(kAllDigits, kDigits + Math.floor(Math.log10(most / range))) : kDigits
}

export function shortNumber(value, digits = kDigits) {
  if (value === 0) return '0'
  const size = Math.abs(value)
  if (size < 1e-4 || size >= 10 ** digits) return value.toExponential(digits - 2).replace(/\.?0+e/, 'e')
  return String(Number(value.toPrecision(digits)))
}

// The least number of these digits from `value` on. REQUIRES: value > 0.
function roundedUp(value, digits) {
  const text = shortNumber(value, digits)
  if (Number(text) >= value) return text
  const shown = text.includes('e') ? digits - 1 : digits
  return shortNumber(value + 10 ** (Math.floor(Math.log10(value)) - shown + 1), digits)
}

// A threshold, rounded up, as in `reeb info`: a level is that of its threshold or a little more, but not of less. With
// as many digits as it takes for a number of which `isSame` says that its level is the same.
export function thresholdText(threshold, isSame = (number) => number >= threshold) {
  if (threshold === 0) return '0'
  if (threshold < 1e-300) return 'above 0'
  for (let digits = kDigits; digits < kAllDigits; ++digits) {
    const text = roundedUp(threshold, digits)
    if (isSame(Number(text))) return text
  }
  return String(threshold)
}

// What a person types as a threshold: a number from 0 on, or with % a share of the range. Null if it is neither.
export function parseThreshold(text, range) {
  const isShare = text.endsWith('%')
  const digits = isShare ? text.slice(0, -1) : text
  const number = Number(digits)
  if (digits.trim() === '' || !Number.isFinite(number) || number < 0) return null
  return isShare ? (number / 100) * range : number
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

// The example at the end of docs/FORMAT.md: a file without positions.
import { readFileSync } from 'node:fs'
import { join } from 'node:path'

export function example(source) {
  const text = readFileSync(join(source, 'docs/FORMAT.md'), 'utf8')
  const hex = /```hex\n([^]*?)```/.exec(text)[1]
  const bytes = hex.split('\n').flatMap((line) => line.slice(4).replace(/#.*/, '').trim().split(/\s+/).filter(Boolean))
  return Uint8Array.from(bytes, (byte) => parseInt(byte, 16))
}

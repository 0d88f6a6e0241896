// What all parts of the page use: its elements, its messages, and numbers as text.
import { FormatError } from '../reading/bytes'
import { SourceError } from '../reading/source'

export const element = <T extends HTMLElement>(id: string) => document.getElementById(id) as T

// For screen readers.
export const announce = (text: string) => (element('announcement').textContent = text)

const capital = (text: string) => text[0].toUpperCase() + text.slice(1)

// Null: nothing is wrong any more. `again`: what a button offers to try once more.
export function say(error: unknown, again: (() => void) | null = null) {
  const message = element('message')
  message.hidden = error === null
  if (error === null) return
  if (error instanceof DOMException && error.name === 'AbortError') return void (message.hidden = true)
  const text = error instanceof FormatError ? `${capital(error.message)}.` : ((error as Error).message ?? String(error))
  message.textContent = error instanceof SourceError ? `${text}\n${error.hint}` : text
  if (!again) return
  const button = document.createElement('button')
  button.textContent = 'Try again'
  button.addEventListener('click', () => {
    say(null)
    again()
  })
  message.append('\n', button)
}

export const bytesText = (bytes: number) =>
  bytes < 2 ** 20 ? `${(bytes / 2 ** 10).toFixed(1)} KiB` : `${(bytes / 2 ** 20).toFixed(1)} MiB`

export const percentOf = (part: number, range: number) => Number((range > 0 ? (100 * part) / range : 0).toPrecision(3))

// What is said under a box that is typed into: why it is refused, or what it yields.

export const kNoThreshold = 'This is not a threshold: give a number from 0 on, or a share of the range like 1%.'

const noteOf = (input) => document.getElementById(`${input.id}-note`)

export function refuse(input, why) {
  input.setAttribute('aria-invalid', 'true')
  noteOf(input).textContent = why
}

export function take(input, note = '') {
  input.removeAttribute('aria-invalid')
  noteOf(input).textContent = note
}

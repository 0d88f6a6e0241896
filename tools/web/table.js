// Tables that sort when a heading is pressed.

// What a cell is sorted by: its numbers, if it is a number or a place, else its text.
function keyOf(cell) {
  const text = (cell.dataset.value ?? cell.textContent).trim()
  const numbers = text.split(',').map((part) => (part.trim() === '' ? NaN : Number(part)))
  return numbers.some(Number.isNaN) ? text : numbers
}

function compare(a, b) {
  if (typeof a === 'string' && typeof b === 'string') return a.localeCompare(b)
  if (typeof a === 'string' || typeof b === 'string') return typeof a === 'string' ? 1 : -1
  const at = a.findIndex((number, i) => number !== b[i])
  return at < 0 ? 0 : a[at] - b[at]
}

export function makeSortable(table, announce) {
  const heads = [...table.tHead.rows[0].cells]
  heads.forEach((head, column) => {
    if (head.classList.contains('fixed')) return
    const button = document.createElement('button')
    button.type = 'button'
    button.textContent = head.textContent
    head.replaceChildren(button)
    button.addEventListener('click', () => {
      // Large numbers first, as they are what one looks for, but small ranks; again: the other way.
      const first = head.classList.contains('number') && button.textContent !== 'rank'
      const descending = head.getAttribute('aria-sort') ? head.getAttribute('aria-sort') === 'ascending' : first
      for (const other of heads) other.removeAttribute('aria-sort')
      head.setAttribute('aria-sort', descending ? 'descending' : 'ascending')
      const body = table.tBodies[0]
      const rows = [...body.rows].map((row) => ({ row, key: keyOf(row.cells[column]) }))
      rows.sort((a, b) => (descending ? compare(b.key, a.key) : compare(a.key, b.key)))
      body.append(...rows.map(({ row }) => row))
      announce(`Sorted by ${button.textContent}, ${descending ? 'descending' : 'ascending'}.`)
    })
  })
}

// Digits in groups of three, which copy as plain digits.
export function groupDigits(cell) {
  const text = cell.textContent
  if (!/^\d{5,}$/.test(text)) return
  const parts = []
  for (let end = text.length; end > 0; end -= 3) parts.unshift(text.slice(Math.max(0, end - 3), end))
  cell.replaceChildren(
    ...parts.map((part, i) => {
      const span = document.createElement('span')
      if (i > 0) span.className = 'group'
      span.textContent = part
      return span
    }),
  )
}

// A table from texts: for what is made in the page.
export function makeTable(caption, columns, rows) {
  const table = document.createElement('table')
  table.createCaption().textContent = caption
  const head = table.createTHead().insertRow()
  for (const name of columns) {
    const cell = document.createElement('th')
    cell.scope = 'col'
    cell.className = 'number'
    cell.textContent = name
    head.append(cell)
  }
  const body = table.createTBody()
  for (const texts of rows) {
    const row = body.insertRow()
    for (const text of texts) {
      const cell = row.insertCell()
      cell.className = 'number'
      cell.textContent = text
    }
  }
  return table
}

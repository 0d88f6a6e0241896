// The page of `reeb report`: connects its parts.
import { makeCloseups } from './closeup.js'
import { onThemeChange } from '../colors.js'
import { readData } from '../data.js'
import { loopsPlot, persistenceDiagram } from '../plots.js'
import { Skeleton } from './skeleton.js'
import { groupDigits, makeSortable } from '../table.js'
import { SkeletonView } from './view.js'

const data = readData()
const announcement = document.getElementById('announcement')
const announce = (text) => (announcement.textContent = text)

for (const cell of document.querySelectorAll('.summary td')) groupDigits(cell)
for (const table of document.querySelectorAll('table.sortable')) makeSortable(table, announce)

function showSkeleton() {
  const message = document.getElementById('skeleton-message')
  if (!data.skeleton) {
    message.textContent = 'There is no skeleton in this page; the notes say why.'
    return
  }
  if (data.skeleton.nodes.vertex.length === 0) {
    message.textContent = 'The graph is empty, so there is nothing to draw.'
    return
  }
  // A height points upwards.
  const up = ['x', 'y', 'z'].indexOf(data.function)
  const view = new SkeletonView(new Skeleton(data.skeleton), up < 0 ? 2 : up, announce)
  for (const button of document.querySelectorAll('[data-pair]'))
    button.addEventListener('click', () => view.showPair(data.pairs[Number(button.dataset.pair)]))
  addEventListener('beforeprint', () => view.print())
  addEventListener('afterprint', () => view.endPrint())
}

function showPlots() {
  const range = data.max - data.min
  const figures = [
    data.loops ? loopsPlot(data.loops, range) : null,
    persistenceDiagram(data.pairs, data.min, data.max, data.pair_count ?? 0),
  ].filter((figure) => figure !== null)
  document.getElementById('figures').append(...figures)
  const message = document.getElementById('plots-message')
  message.hidden = figures.length > 0
  message.textContent = data.loops
    ? 'There are no pairs of positive persistence to plot.'
    : `${data.no_pairs}, so there is nothing to plot.`
}

function showCloseups() {
  const place = document.getElementById('closeups')
  if (!place || data.closeups.length === 0) return
  const closeups = makeCloseups(place, data.closeups)
  for (const button of document.querySelectorAll('[data-closeup]'))
    button.addEventListener('click', () => closeups.show(Number(button.dataset.closeup)))
  onThemeChange(closeups.draw)
  for (const change of ['resize', 'beforeprint', 'afterprint']) addEventListener(change, closeups.draw)
}

// Paper is light. What is drawn for it is drawn after this.
addEventListener('beforeprint', () => document.documentElement.classList.add('paper'))
addEventListener('afterprint', () => document.documentElement.classList.remove('paper'))

showPlots()
showCloseups()
showSkeleton()

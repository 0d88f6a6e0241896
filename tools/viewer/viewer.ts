// The viewer's page: connects its controls.
import { onThemeChange } from '../web/colors.js'
import { fileOfAddress, hasState, readState, saveState } from './panels/address'
import { removeBackdrop, takeBackdrop } from './panels/backdrop_control'
import { setChoice } from './panels/choice'
import { setColoring } from './panels/content'
import { chooseBeside, choosePair } from './panels/features'
import { readBudget, readThreshold, setThreshold, thresholdAt } from './panels/level_control'
import { applyState, openBlob, openUrl } from './panels/opening'
import { element } from './panels/page'
import { makeViewer, viewsOf } from './panels/state'
import type { OpenFile } from './panels/state'
import { fit, redraw, savePictures } from './panels/views'

const viewer = makeViewer()
const input = (id: string) => element<HTMLInputElement>(id)

// Nothing, while no file is open.
const withFile = (run: (file: OpenFile) => void) => viewer.file && run(viewer.file)

// The level.
input('level').addEventListener('input', () => {
  const begin = performance.now()
  withFile((file) => void setThreshold(viewer, file, thresholdAt(file.header, Number(input('level').value))))
  element('drawn').dataset.script = (performance.now() - begin).toFixed(2)
})
input('threshold').addEventListener('change', () => withFile((file) => readThreshold(viewer, file)))
input('budget').addEventListener('change', () => withFile((file) => readBudget(viewer, file)))
element('stop').addEventListener('click', () => withFile(({ session }) => session.pause()))

// The pictures.
input('coloring').addEventListener('change', () => {
  setColoring(viewer)
  saveState(viewer)
})
for (const button of document.querySelectorAll<HTMLElement>('[data-view]'))
  button.addEventListener('click', () => fit(viewer, { x: 0, y: 1, z: 2 }[button.dataset.view!]))
element('picture').addEventListener('click', () => savePictures(viewer))
onThemeChange(() => {
  for (const { picture } of viewsOf(viewer)) picture.recolor()
  redraw(viewer)
})

// Features.
element('figures').addEventListener('click', (event) => {
  const mark = (event.target as Element).closest<SVGElement>('[data-mark]')
  if (mark) withFile((file) => choosePair(viewer, file, Number(mark.dataset.mark)))
})
element('figures').addEventListener('keydown', (event) => {
  const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key] as 1 | -1 | undefined
  if (!step || !(event.target as Element).closest('#plot-diagram svg')) return
  event.preventDefault()
  withFile((file) => chooseBeside(viewer, file, step))
})
addEventListener('keydown', (event) => event.key === 'Escape' && withFile((file) => setChoice(viewer, file, null)))

// Files. An input that has been emptied takes the same file again.
const take = (file: File | undefined) => {
  if (file && /\.ply$/i.test(file.name)) void takeBackdrop(viewer, file)
  else if (file) openBlob(viewer, file)
}
for (const id of ['pick', 'backdrop']) input(id).addEventListener('click', () => (input(id).value = ''))
input('pick').addEventListener('change', () => take(input('pick').files?.[0]))
input('backdrop').addEventListener('change', () => {
  const file = input('backdrop').files?.[0]
  if (file) void takeBackdrop(viewer, file)
})
element('no-backdrop').addEventListener('click', () => withFile((file) => removeBackdrop(viewer, file)))
element('fetch').addEventListener('submit', (event) => {
  event.preventDefault()
  openUrl(viewer, input('url').value.trim())
})
for (const name of ['dragenter', 'dragover', 'dragleave', 'drop'])
  addEventListener(name, (event) => {
    event.preventDefault()
    document.body.classList.toggle('dropping', name === 'dragenter' || name === 'dragover')
  })
addEventListener('drop', (event) => take(event.dataTransfer?.files[0]))

// The address.
addEventListener('hashchange', () => {
  const state = readState(viewer)
  withFile((file) => (hasState() ? void applyState(viewer, file, state) : saveState(viewer)))
})
const asked = fileOfAddress()
if (asked) openUrl(viewer, asked)

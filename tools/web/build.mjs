// Bundles pages, each with its style and script, into one text, and writes them as C++.
//
//   node build.mjs FOLDER OUT.cpp     FOLDER has node_modules
import { createRequire } from 'node:module'
import { readFileSync, writeFileSync } from 'node:fs'
import { dirname, join } from 'node:path'
import { fileURLToPath } from 'node:url'

const [folder, output] = process.argv.slice(2)
const source = dirname(fileURLToPath(import.meta.url))
const { build } = createRequire(join(folder, 'package.json'))('esbuild')

async function bundle(name) {
  const result = await build({
    entryPoints: [join(source, name)],
    bundle: true,
    minify: true,
    write: false,
    format: 'iife',
    target: ['es2021'],
    charset: 'utf8',
    legalComments: 'none', // NOTICE.txt is in the page
    nodePaths: [join(folder, 'node_modules')],
    absWorkingDir: source,
    logLevel: 'warning',
  })
  return result.outputFiles[0].text.trim()
}

// The terms of what is bundled, in full.
const kSoftware = {
  three: ['three.js', 'https://threejs.org', 'LICENSE'],
  fzstd: ['fzstd', 'https://github.com/101arrowz/fzstd', 'LICENSE'],
  'xxhash-wasm': ['xxhash-wasm', 'https://github.com/jungomi/xxhash-wasm', 'LICENSE.md'],
}
function notice(packages) {
  const parts = packages.map((name) => {
    const [title, address, file] = kSoftware[name]
    const licence = readFileSync(join(folder, 'node_modules', name, file), 'utf8')
    const { version } = JSON.parse(readFileSync(join(folder, 'node_modules', name, 'package.json'), 'utf8'))
    return `The script of this page contains parts of ${title} ${version} (${address}).\n\n${licence.trim()}`
  })
  return parts.join('\n\n')
}

function insert(page, place, text) {
  const parts = page.split(place)
  if (parts.length !== 2) throw new Error(`${place} is there ${parts.length - 1} times`)
  return parts.join(text)
}

// `name`: of the page, its style and its script, without endings.
async function makePage(name, scriptName, packages) {
  const script = await bundle(scriptName)
  if (/<\/script|<!--/i.test(script)) throw new Error('the script would end early inside of a page')
  let page = readFileSync(join(source, `${name}.html`), 'utf8')
  page = page.replaceAll(/<!--part:(\w+\.html)-->\n/g, (_, part) => readFileSync(join(source, 'parts', part), 'utf8'))
  page = insert(page, '/*reeb-style*/', await bundle(`${name}.css`))
  page = insert(page, '/*reeb-script*/', script)
  return insert(page, 'reeb-notice', notice(packages).replaceAll('&', '&amp;').replaceAll('<', '&lt;'))
}

// Pieces, since some compilers limit the length of a literal.
function literal(page) {
  const delimiter = 'reeb_page'
  if (page.includes(`)${delimiter}"`)) throw new Error('the page contains the end of a literal')
  return page
    .match(/[^]{1,16000}/gu)
    .map((piece) => `R"${delimiter}(${piece})${delimiter}"`)
    .join('\n')
}

const report = await makePage('report/report', 'report/report.js', ['three'])
const viewer = await makePage('../viewer/viewer', '../viewer/viewer.ts', ['three', 'fzstd', 'xxhash-wasm'])
writeFileSync(join(dirname(output), 'viewer.html'), viewer)
writeFileSync(
  output,
  `// Made by tools/web/build.mjs.
#include "tools/report/page_template.h"
#include "tools/view/viewer_page.h"

namespace reeb::tools {

std::string_view report_template() {
  static constexpr char kPage[] =
${literal(report)};
  return {kPage, sizeof kPage - 1};
}

std::string_view viewer_page() {
  static constexpr char kPage[] =
${literal(viewer)};
  return {kPage, sizeof kPage - 1};
}

}  // namespace reeb::tools
`,
)

// Bundles a page with its style and script into one text, and writes it as C++.
//
//   node build.mjs FOLDER OUT.cpp     FOLDER has node_modules
import { createRequire } from 'node:module'
import { readFileSync, writeFileSync } from 'node:fs'
import { dirname, join } from 'node:path'
import { fileURLToPath } from 'node:url'

const [folder, output] = process.argv.slice(2)
const source = dirname(fileURLToPath(import.meta.url))
const { buildSync } = createRequire(join(folder, 'package.json'))('esbuild')

function bundle(name) {
  const result = buildSync({
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
function notice() {
  const licence = readFileSync(join(folder, 'node_modules/three/LICENSE'), 'utf8')
  const { version } = JSON.parse(readFileSync(join(folder, 'node_modules/three/package.json'), 'utf8'))
  return `The script of this page contains parts of three.js ${version} (https://threejs.org).\n\n${licence.trim()}`
}

function insert(page, place, text) {
  const parts = page.split(place)
  if (parts.length !== 2) throw new Error(`${place} is there ${parts.length - 1} times`)
  return parts.join(text)
}

const script = bundle('report.js')
if (/<\/script|<!--/i.test(script)) throw new Error('the script would end early inside of a page')
let page = readFileSync(join(source, 'report.html'), 'utf8')
page = insert(page, '/*reeb-style*/', bundle('report.css'))
page = insert(page, '/*reeb-script*/', script)
page = insert(page, 'reeb-notice', notice().replaceAll('&', '&amp;').replaceAll('<', '&lt;'))

// Pieces, since some compilers limit the length of a literal.
const delimiter = 'reeb_page'
if (page.includes(`)${delimiter}"`)) throw new Error('the page contains the end of a literal')
const pieces = page.match(/[^]{1,16000}/gu).map((piece) => `R"${delimiter}(${piece})${delimiter}"`)
writeFileSync(
  output,
  `// Made by tools/web/build.mjs.
#include "tools/report/page_template.h"

namespace reeb::tools {

std::string_view report_template() {
  static constexpr char kPage[] =
${pieces.join('\n')};
  return {kPage, sizeof kPage - 1};
}

}  // namespace reeb::tools
`,
)

// A module of tools/viewer as Node.js can load it: the packages are those of the build.
import { createRequire } from 'node:module'
import { join } from 'node:path'

// `packages`: the folder of node_modules. `work`: where the bundle is written.
export async function bundled(source, module, packages, work) {
  const { build } = createRequire(join(packages, 'package.json'))('esbuild')
  const outfile = join(work, `${module}.mjs`)
  await build({
    entryPoints: [join(source, 'tools/viewer', `${module}.ts`)],
    bundle: true, format: 'esm', platform: 'node', outfile, nodePaths: [join(packages, 'node_modules')], logLevel: 'warning',
  })
  return import(outfile)
}

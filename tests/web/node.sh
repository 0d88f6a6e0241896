#!/usr/bin/env bash
# Node.js for the tests. With threads in the background it can wait for ever where promises are awaited and nothing
# else is to do: https://github.com/nodejs/node/issues/54918
exec "$(command -v node || command -v nodejs)" --single-threaded "$@"

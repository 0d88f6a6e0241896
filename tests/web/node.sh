#!/usr/bin/env bash
# Node.js for the tests. With background threads, it can hang while it awaits a promise and has nothing else to do:
# https://github.com/nodejs/node/issues/54918
exec "$(command -v node || command -v nodejs)" --single-threaded "$@"

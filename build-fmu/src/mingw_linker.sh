#!/bin/sh
# GCC for Windows, with names of files in the target directory as seen from there. The linker orders imports by the names of
# files, so that with whole names the order would follow the place of the directory.
cd "$MORIS_TARGET_DIRECTORY" || exit 1
for argument do
    shift
    set -- "$@" "${argument#"$MORIS_TARGET_DIRECTORY"/}"
done
exec x86_64-w64-mingw32-gcc "$@"

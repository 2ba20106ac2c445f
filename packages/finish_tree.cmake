# SPDX-License-Identifier: MIT
# What CPack runs before it packs: Debian's compressed manuals and change logs, and the time of the sources for every
# file, so that the same sources give the same bytes.
set(tree ${CPACK_TEMPORARY_DIRECTORY})
file(GLOB_RECURSE texts ${tree}/*/usr/share/man/man1/*.1 ${tree}/*/usr/share/doc/*/changelog
     ${tree}/*/usr/share/doc/*/changelog.Debian)
foreach(text IN LISTS texts)
  execute_process(COMMAND gzip -9nf ${text} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
if(DEFINED ENV{SOURCE_DATE_EPOCH})
  execute_process(COMMAND find ${tree} -exec touch -h -d @$ENV{SOURCE_DATE_EPOCH} "{}" +
    COMMAND_ERROR_IS_FATAL ANY)
endif()

# cmake -D SOURCE=.. -D TEMPLATE=.. -D OUTPUT=.. -P Commit.cmake
# Writes OUTPUT with the commit of the tree SOURCE, unless it is up to date. The commit comes from the
# tree's own repository, never from an enclosing one, or else from cmake/commit.txt, which `git archive`
# fills in. Without either it is empty. Errors of git are ignored.
set(COMMIT "")
if(EXISTS "${SOURCE}/.git")
  # Hooks of git set these to the repository in which they run.
  foreach(name GIT_DIR GIT_WORK_TREE GIT_COMMON_DIR GIT_INDEX_FILE GIT_PREFIX)
    unset(ENV{${name}})
  endforeach()
  file(REAL_PATH "${SOURCE}" tree)
  get_filename_component(around "${tree}" DIRECTORY)
  set(ENV{GIT_CEILING_DIRECTORIES} "${around}")
  set(git git --no-optional-locks -c core.fsmonitor=false)
  execute_process(COMMAND ${git} rev-parse --verify HEAD WORKING_DIRECTORY "${tree}"
                  OUTPUT_VARIABLE head RESULT_VARIABLE head_result ERROR_QUIET)
  execute_process(COMMAND ${git} status --porcelain --untracked-files=all WORKING_DIRECTORY "${tree}"
                  OUTPUT_VARIABLE changes RESULT_VARIABLE changes_result ERROR_QUIET)
  if(head_result EQUAL 0 AND changes_result EQUAL 0)
    string(SUBSTRING "${head}" 0 8 COMMIT)
    # A new source is compiled before it is tracked; other new files do not count.
    if(changes MATCHES "(^|\n)([^?]|[?][?] ([^\n]*\\.[ch]pp|\"?config/(devices|texts)/[^\n]*\\.json)\"?\n)")
      string(APPEND COMMIT ", modified")
    endif()
  endif()
endif()
if(COMMIT STREQUAL "" AND EXISTS "${SOURCE}/cmake/commit.txt")
  file(STRINGS "${SOURCE}/cmake/commit.txt" archived LIMIT_COUNT 1)
  if(archived MATCHES "^[0-9a-f]+$")
    string(SUBSTRING "${archived}" 0 8 COMMIT)
  endif()
endif()
configure_file("${TEMPLATE}" "${OUTPUT}" @ONLY)

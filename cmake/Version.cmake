# The version is set by project() in CMakeLists.txt. All other places must agree.
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${CMAKE_SOURCE_DIR}/CITATION.cff")
file(STRINGS CITATION.cff cited REGEX "^version:")
if(NOT cited STREQUAL "version: ${PROJECT_VERSION}")
  message(FATAL_ERROR "CITATION.cff says \"${cited}\", and the project is of version ${PROJECT_VERSION}: "
                      "write \"version: ${PROJECT_VERSION}\" there")
endif()

# touchtrial_add_commit(TARGET)
# Adds a source with the commit (app/commit.hpp). The commit is read at each build; the source is
# recompiled only if it changed.
function(touchtrial_add_commit target)
  set(source "${CMAKE_CURRENT_BINARY_DIR}/commit.cpp")
  set(write "${CMAKE_COMMAND}" -D "SOURCE=${CMAKE_SOURCE_DIR}" -D "OUTPUT=${source}"
            -D "TEMPLATE=${CMAKE_SOURCE_DIR}/app/commit.cpp.in" -P "${CMAKE_SOURCE_DIR}/cmake/Commit.cmake")
  execute_process(COMMAND ${write} COMMAND_ERROR_IS_FATAL ANY)  # for tools that read sources without a build
  add_custom_target(${target}_commit COMMAND ${write} BYPRODUCTS "${source}"
                    COMMENT "Looking up the commit" VERBATIM)
  target_sources(${target} PRIVATE "${source}")
  add_dependencies(${target} ${target}_commit)
endfunction()

# The version is project()'s, in CMakeLists.txt. Whatever else states it must agree.
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${CMAKE_SOURCE_DIR}/CITATION.cff")
file(STRINGS CITATION.cff cited REGEX "^version:")
if(NOT cited STREQUAL "version: ${PROJECT_VERSION}")
  message(FATAL_ERROR "CITATION.cff says \"${cited}\", and the project is of version ${PROJECT_VERSION}: "
                      "write \"version: ${PROJECT_VERSION}\" there")
endif()

# touchtrial_add_commit(TARGET)
# Adds a source that knows the commit (app/commit.hpp). It is looked up at each build, and compiled again only
# when the commit is another.
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

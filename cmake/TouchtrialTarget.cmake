# Reduces the compile time of code that is not performance-critical. At this level GCC gives false
# warnings of uninitialised values.
set(TOUCHTRIAL_UNHURRIED -O1 -Wno-maybe-uninitialized)

option(TOUCHTRIAL_UNITY "Compile several files at a time: faster from scratch, slower after a small change" OFF)

# The number of files per unit, for the product and for tests.
set(TOUCHTRIAL_BATCH 24)
set(TOUCHTRIAL_TEST_BATCH 16)
# Long enough for a busy machine: only a test that hangs takes longer.
set(TOUCHTRIAL_TEST_TIMEOUT_S 1800)

# touchtrial_library(NAME [UNHURRIED] [ONLY files...] [EXCEPT folders and files...] [PUBLIC targets...]
#                    [PRIVATE libraries...])
# One static library per folder, from every .cpp file in and below it, except those of libraries in its
# subfolders. PUBLIC: targets of this project, along the arrows of docs/architecture.md; PRIVATE:
# third-party libraries, whose headers no public header includes. UNHURRIED: not worth optimising. With
# TOUCHTRIAL_UNITY many files of the library are compiled at a time, so names in the anonymous namespaces of
# one namespace must differ. The code is position-independent for the Python module, a shared library;
# hidden symbols keep calls and data in the program direct.
function(touchtrial_library name)
  cmake_parse_arguments(ARG "UNHURRIED" "" "ONLY;EXCEPT;PUBLIC;PRIVATE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.cpp")
  list(FILTER sources EXCLUDE REGEX "/main\\.cpp$")
  foreach(folder ${ARG_EXCEPT})
    list(FILTER sources EXCLUDE REGEX "^${CMAKE_CURRENT_SOURCE_DIR}/${folder}(/|$)")
  endforeach()
  if(ARG_ONLY)
    list(TRANSFORM ARG_ONLY PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/" OUTPUT_VARIABLE sources)
  endif()
  if(NOT sources)
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE ${ARG_PUBLIC})
    return()
  endif()
  add_library(${name} STATIC ${sources})
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden
                                           VISIBILITY_INLINES_HIDDEN ON)
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}>)
  target_link_libraries(${name} PUBLIC ${ARG_PUBLIC} PRIVATE $<BUILD_INTERFACE:touchtrial_settings> ${ARG_PRIVATE})
  if(ARG_UNHURRIED)
    target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:${TOUCHTRIAL_UNHURRIED}>)
  endif()
  if(TOUCHTRIAL_UNITY)
    touchtrial_compile_together(${name} ${sources})
  endif()
endfunction()

# touchtrial_built_in_text(TARGET FILE HEADER NAMESPACE FUNCTION)
# Defines a function that returns the text of a file, as its header declares it; a change of the file
# reconfigures the build.
function(touchtrial_built_in_text target file header name_space function)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/${file}")
  file(READ "${CMAKE_CURRENT_SOURCE_DIR}/${file}" text)
  configure_file("${CMAKE_SOURCE_DIR}/cmake/built_in_text.cpp.in" ${function}.cpp @ONLY)
  target_sources(${target} PRIVATE "${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp")
endfunction()

# Compiles the files of a target TOUCHTRIAL_BATCH at a time, because headers take most of a small unit's time.
# Files that Highway compiles once per SIMD target include themselves, so each remains a unit.
function(touchtrial_compile_together target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  touchtrial_allow_included_sources(${target})
  set(files 0)
  foreach(source ${ARGN})
    file(STRINGS "${source}" per_target REGEX "#include <hwy/foreach_target\\.h>")
    if(per_target)
      continue()
    endif()
    math(EXPR batch "${files} / ${TOUCHTRIAL_BATCH}")
    math(EXPR files "${files} + 1")
    set_source_files_properties("${source}" PROPERTIES UNITY_GROUP "${target}_${batch}")
  endforeach()
endfunction()

# GCC treats included sources as headers, and warns of anonymous namespaces in them.
function(touchtrial_allow_included_sources target)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  endif()
endfunction()

# touchtrial_joined(VARIABLE BATCH NAME sources...)
# Sets the variable to translation units, each of which includes BATCH of the sources. If
# TOUCHTRIAL_UNITY is off, sets it to the sources themselves.
function(touchtrial_joined variable batch name)
  if(NOT TOUCHTRIAL_UNITY)
    set(${variable} ${ARGN} PARENT_SCOPE)
    return()
  endif()
  set(joiner "${CMAKE_SOURCE_DIR}/cmake/JoinedTests.cmake")
  set(units "")
  list(LENGTH ARGN count)
  math(EXPR last "${count} - 1")
  foreach(first RANGE 0 ${last} ${batch})
    list(SUBLIST ARGN ${first} ${batch} part)
    string(REPLACE ";" "," joined "${part}")
    set(unit "${CMAKE_CURRENT_BINARY_DIR}/${name}_from_${first}.cpp")
    add_custom_command(OUTPUT "${unit}"
      COMMAND "${CMAKE_COMMAND}" -D "OUTPUT=${unit}" -D "SOURCES=${joined}" -P "${joiner}"
      DEPENDS ${part} "${joiner}" COMMENT "" VERBATIM)
    list(APPEND units "${unit}")
  endforeach()
  set(${variable} ${units} PARENT_SCOPE)
endfunction()

# touchtrial_test(NAME [WHOLE] [JOINED] [COMPUTES] [EXCEPT folders...] [LIBRARIES ...])
# One test program per folder, from every *_test.cpp file in and below it, except those of folders with
# their own program. Each test case is a CTest test; with WHOLE the program is one test, whose cases share
# expensive fixtures. COMPUTES: the tests compute for so long that optimising them pays.
function(touchtrial_test name)
  cmake_parse_arguments(ARG "JOINED;WHOLE;COMPUTES" "" "EXCEPT;LIBRARIES" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*_test.cpp")
  foreach(folder ${ARG_EXCEPT})
    list(FILTER sources EXCLUDE REGEX "^${CMAKE_CURRENT_SOURCE_DIR}/${folder}/")
  endforeach()
  set(units ${sources})
  if(ARG_JOINED)
    touchtrial_joined(units ${TOUCHTRIAL_TEST_BATCH} ${name} ${sources})
  endif()
  add_executable(${name} ${units})
  target_include_directories(${name} PRIVATE "${CMAKE_SOURCE_DIR}/tests" "${CMAKE_SOURCE_DIR}")
  target_link_libraries(${name} PRIVATE ${ARG_LIBRARIES} touchtrial_test_support touchtrial_settings)
  if(TOUCHTRIAL_UNITY)
    touchtrial_allow_included_sources(${name})
  endif()
  # Optimising the test framework costs more time than the tests then save.
  set(level -O0)
  if(ARG_COMPUTES)
    set(level ${TOUCHTRIAL_UNHURRIED})
  endif()
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:${level}>)
  if(MOLD_PROGRAM AND NOT TOUCHTRIAL_SANITIZE)
    target_link_options(${name} PRIVATE -fuse-ld=mold)
  endif()
  if(ARG_WHOLE)
    add_test(NAME ${name} COMMAND ${name})
    set_tests_properties(${name} PROPERTIES TIMEOUT ${TOUCHTRIAL_TEST_TIMEOUT_S})
    return()
  endif()
  catch_discover_tests(${name} TEST_PREFIX "${name}:"
    PROPERTIES TIMEOUT ${TOUCHTRIAL_TEST_TIMEOUT_S})
endfunction()

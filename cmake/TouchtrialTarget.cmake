# Compiles a target in less time, for code that spends none: at this level GCC sees uninitialised
# values that are not there.
set(TOUCHTRIAL_UNHURRIED -O1 -Wno-maybe-uninitialized)

# touchtrial_library(NAME [UNHURRIED] [PUBLIC targets...] [PRIVATE libraries...])
# One static library a folder, of every .cpp file in and below it. PUBLIC: targets of ours, along
# the arrows of docs/architecture.md; PRIVATE: third-party libraries, whose headers no public header
# includes. UNHURRIED: nothing in it is worth optimising; files that read and write JSON and other
# texts are so everywhere.
function(touchtrial_library name)
  cmake_parse_arguments(ARG "UNHURRIED" "" "PUBLIC;PRIVATE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.cpp")
  list(FILTER sources EXCLUDE REGEX "/main\\.cpp$")
  if(NOT sources)
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE ${ARG_PUBLIC})
    return()
  endif()
  add_library(${name} STATIC ${sources})
  target_include_directories(${name} PUBLIC "${CMAKE_SOURCE_DIR}")
  target_link_libraries(${name} PUBLIC ${ARG_PUBLIC} PRIVATE touchtrial_settings ${ARG_PRIVATE})
  if(ARG_UNHURRIED)
    target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:${TOUCHTRIAL_UNHURRIED}>)
    return()
  endif()
  list(FILTER sources INCLUDE REGEX "(_json|_text|_csv|_html|_object|manifest|_key_file)\\.cpp$")
  set_source_files_properties(${sources} PROPERTIES
    COMPILE_OPTIONS "$<$<CONFIG:Release>:${TOUCHTRIAL_UNHURRIED}>")
endfunction()

# touchtrial_test(NAME [EXCEPT folders...] [LIBRARIES ...])
# One test program a folder, of every *_test.cpp file in and below it, except those of folders that
# have a program of their own; each test case is a CTest test.
function(touchtrial_test name)
  cmake_parse_arguments(ARG "" "" "EXCEPT;LIBRARIES" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*_test.cpp")
  foreach(folder ${ARG_EXCEPT})
    list(FILTER sources EXCLUDE REGEX "^${CMAKE_CURRENT_SOURCE_DIR}/${folder}/")
  endforeach()
  add_executable(${name} ${sources})
  target_include_directories(${name} PRIVATE "${CMAKE_SOURCE_DIR}/tests")
  target_link_libraries(${name} PRIVATE ${ARG_LIBRARIES} touchtrial_test_support touchtrial_settings)
  # Optimising the test framework costs more time than the tests then save.
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:${TOUCHTRIAL_UNHURRIED}>)
  catch_discover_tests(${name} TEST_PREFIX "${name}: " PROPERTIES TIMEOUT 600)
endfunction()

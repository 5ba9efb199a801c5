# touchtrial_links_with(VARIABLE PROBE FORWARDERS [INCLUDES folders...] [LIBRARIES libraries...])
# Sets the cached variable to whether cmake/probes/PROBE.cpp links with only the forwarders, without the
# library whose functions they look up.
function(touchtrial_links_with variable probe forwarders)
  if(DEFINED ${variable})
    return()
  endif()
  cmake_parse_arguments(ARG "" "" "INCLUDES;LIBRARIES" ${ARGN})
  try_compile(${variable} "${CMAKE_BINARY_DIR}/probes/${probe}"
    SOURCES "${CMAKE_SOURCE_DIR}/cmake/probes/${probe}.cpp" "${CMAKE_SOURCE_DIR}/${forwarders}"
            "${CMAKE_SOURCE_DIR}/core/errors.cpp" "${CMAKE_SOURCE_DIR}/core/printable.cpp"
    CMAKE_FLAGS "-DINCLUDE_DIRECTORIES=${CMAKE_SOURCE_DIR};${ARG_INCLUDES}"
    LINK_LIBRARIES ${ARG_LIBRARIES} ${CMAKE_DL_LIBS}
    CXX_STANDARD 20 CXX_STANDARD_REQUIRED ON OUTPUT_VARIABLE output)
  if(${variable})
    message(STATUS "Loaded when needed: ${probe}")
  else()
    file(WRITE "${CMAKE_BINARY_DIR}/probes/${probe}.log" "${output}")
    message(STATUS "Linked as a shared library: ${probe} (${CMAKE_BINARY_DIR}/probes/${probe}.log has the reason)")
  endif()
endfunction()

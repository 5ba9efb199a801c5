# cmake -D OUTPUT=.. -D SOURCES=a.cpp,b.cpp -P JoinedTests.cmake
# One translation unit of several tests, as headers cost most of a test's compilation. Each file is
# included in a namespace of its own, so that files need not know of one another's names; all
# headers come before, where they belong.
string(REPLACE "," ";" sources "${SOURCES}")
set(headers "")
set(units "")
set(number 0)
foreach(source IN LISTS sources)
  math(EXPR number "${number} + 1")
  file(STRINGS "${source}" includes REGEX "^#include ")
  list(APPEND headers ${includes})
  file(STRINGS "${source}" opened REGEX "^namespace [a-z_:]+ {")
  string(APPEND units "\nnamespace touchtrial::unit_${number} {\n")
  list(REMOVE_DUPLICATES opened)
  foreach(line IN LISTS opened)
    string(REGEX REPLACE "^namespace ([a-z_:]+) {.*" "\\1" name "${line}")
    string(APPEND units "namespace ${name} {\nusing namespace ::${name};\n}\n")
  endforeach()
  string(APPEND units "#include \"${source}\"\n}\n")
endforeach()
list(REMOVE_DUPLICATES headers)
list(JOIN headers "\n" headers)
file(WRITE "${OUTPUT}" "${headers}\n${units}")

# One place for the compiler's flags: every target of the project gets them.
find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CCACHE_PROGRAM}")
endif()

# Debug builds are for writing code: mold links the program in a second.
find_program(MOLD_PROGRAM mold)
if(MOLD_PROGRAM AND CMAKE_BUILD_TYPE STREQUAL "Debug" AND NOT CMAKE_INTERPROCEDURAL_OPTIMIZATION)
  add_link_options(-fuse-ld=mold)
endif()

# Warnings are errors where CMAKE_COMPILE_WARNING_AS_ERROR is on: in developers' presets and in
# continuous integration, but never for users, whose compilers and libraries may give other warnings.
add_library(touchtrial_settings INTERFACE)
target_compile_features(touchtrial_settings INTERFACE cxx_std_20)
target_compile_options(touchtrial_settings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor
  -Wold-style-cast -Woverloaded-virtual -Wformat=2
  # No contraction to fused multiply-add: results must not depend on the compiler's choices.
  -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12 falsely reports overlapping copies in std::string's operator+ (its bug 105651).
  target_compile_options(touchtrial_settings INTERFACE -Wno-restrict)
  if(CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 13)
    # GCC 13 and 14 falsely report uninitialised values in copies of std::variant, and dangling
    # references from functions with a temporary argument.
    target_compile_options(touchtrial_settings INTERFACE -Wno-maybe-uninitialized -Wno-dangling-reference)
  endif()
endif()
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  # The minimum processor. Kernels for newer ones are chosen at run time.
  target_compile_options(touchtrial_settings INTERFACE -march=x86-64-v2)
endif()
if(TOUCHTRIAL_SANITIZE)
  target_compile_options(touchtrial_settings INTERFACE
    -fsanitize=${TOUCHTRIAL_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(touchtrial_settings INTERFACE -fsanitize=${TOUCHTRIAL_SANITIZE})
  if(TOUCHTRIAL_SANITIZE MATCHES "address")
    add_library(touchtrial_kept_libraries OBJECT "${CMAKE_SOURCE_DIR}/tests/support/keep_libraries.cpp")
    target_sources(touchtrial_settings INTERFACE $<TARGET_OBJECTS:touchtrial_kept_libraries>)
    target_link_options(touchtrial_settings INTERFACE -Wl,--export-dynamic-symbol=dlclose)
  endif()
  if(TOUCHTRIAL_SANITIZE STREQUAL "thread")
    # Replaces oneTBB, whose build is not instrumented for the sanitizer: tests/tsan/README.md.
    target_include_directories(touchtrial_settings BEFORE INTERFACE "${CMAKE_SOURCE_DIR}/tests/tsan")
  endif()
endif()
if(TOUCHTRIAL_FUZZ)
  target_compile_options(touchtrial_settings INTERFACE -fsanitize=fuzzer-no-link)
endif()

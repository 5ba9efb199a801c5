# Touchtrial's third-party dependencies. The versions in Debian 12 and 13 are sufficient.
set(TOUCHTRIAL_NEED REQUIRED)
include(EngineDependencies)
if(NOT OPENCV_HEADERS OR NOT OPENCV_CORE OR NOT OPENCV_IMGPROC)
  message(FATAL_ERROR "OpenCV's core and imgproc are missing; run scripts/install-dependencies")
endif()
find_package(nlohmann_json REQUIRED)
find_package(spdlog REQUIRED)
find_package(fmt REQUIRED)
find_package(SQLiteCpp REQUIRED)
find_package(CLI11 REQUIRED)
find_package(Boost REQUIRED CONFIG)
find_package(zstd QUIET)
if(TARGET zstd::libzstd_shared)
  add_library(touchtrial_zstd ALIAS zstd::libzstd_shared)
elseif(TARGET zstd::libzstd_static)
  add_library(touchtrial_zstd ALIAS zstd::libzstd_static)
else()
  pkg_check_modules(zstd REQUIRED IMPORTED_TARGET GLOBAL libzstd)
  add_library(touchtrial_zstd ALIAS PkgConfig::zstd)
endif()
pkg_check_modules(nlopt REQUIRED IMPORTED_TARGET GLOBAL nlopt)

# For the module that sync and merge load (record/merging/postgres).
pkg_check_modules(libpq REQUIRED IMPORTED_TARGET GLOBAL libpq)

pkg_check_modules(libusb REQUIRED IMPORTED_TARGET GLOBAL libusb-1.0)

find_package(glfw3 REQUIRED)
find_package(OpenGL REQUIRED)
# Debian's Dear ImGui includes the GLFW and OpenGL 3 backends, but does not link these two libraries.
pkg_check_modules(imgui REQUIRED IMPORTED_TARGET GLOBAL imgui)
pkg_check_modules(freetype REQUIRED IMPORTED_TARGET GLOBAL freetype2)
# Only the header; the library is loaded when sound is first used.
pkg_check_modules(portaudio REQUIRED portaudio-2.0)

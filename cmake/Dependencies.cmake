# Everything that Touchtrial uses and did not write. Debian 12's versions serve.
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(spdlog REQUIRED)
find_package(fmt REQUIRED)
find_package(SQLiteCpp REQUIRED)
find_package(CLI11 REQUIRED)
find_package(Boost REQUIRED)
find_package(TBB REQUIRED)
find_package(zstd QUIET)
if(TARGET zstd::libzstd_shared)
  add_library(touchtrial_zstd ALIAS zstd::libzstd_shared)
elseif(TARGET zstd::libzstd_static)
  add_library(touchtrial_zstd ALIAS zstd::libzstd_static)
else()
  pkg_check_modules(zstd REQUIRED IMPORTED_TARGET GLOBAL libzstd)
  add_library(touchtrial_zstd ALIAS PkgConfig::zstd)
endif()
find_package(ZLIB REQUIRED)
pkg_check_modules(fftw3 REQUIRED IMPORTED_TARGET GLOBAL fftw3)
pkg_check_modules(fftw3f REQUIRED IMPORTED_TARGET GLOBAL fftw3f)
pkg_check_modules(nlopt REQUIRED IMPORTED_TARGET GLOBAL nlopt)
pkg_check_modules(libsodium REQUIRED IMPORTED_TARGET GLOBAL libsodium)

# A newer libpqxx may bring a CMake package; pkg-config finds every version.
pkg_check_modules(libpqxx REQUIRED IMPORTED_TARGET GLOBAL libpqxx libpq)

pkg_check_modules(libusb REQUIRED IMPORTED_TARGET GLOBAL libusb-1.0)

find_package(glfw3 REQUIRED)
find_package(OpenGL REQUIRED)
# Debian's Dear ImGui holds the GLFW and OpenGL 3 backends, and leaves these two to whoever links it.
pkg_check_modules(imgui REQUIRED IMPORTED_TARGET GLOBAL imgui)
pkg_check_modules(freetype REQUIRED IMPORTED_TARGET GLOBAL freetype2)
pkg_check_modules(portaudio REQUIRED IMPORTED_TARGET GLOBAL portaudio-2.0)

find_package(hwy QUIET)
if(TARGET hwy::hwy)
  add_library(touchtrial_hwy ALIAS hwy::hwy)
else()
  pkg_check_modules(hwy REQUIRED IMPORTED_TARGET GLOBAL libhwy)
  add_library(touchtrial_hwy ALIAS PkgConfig::hwy)
endif()

# Only what OpenCV computes with: its own package file wants all of its modules installed, and what
# these bring along. Its headers warn under C++20; as a system target they stay quiet.
find_path(OPENCV_HEADERS opencv2/imgproc.hpp PATH_SUFFIXES opencv4 REQUIRED)
find_library(OPENCV_CORE opencv_core REQUIRED)
find_library(OPENCV_IMGPROC opencv_imgproc REQUIRED)
add_library(touchtrial_opencv INTERFACE)
target_include_directories(touchtrial_opencv SYSTEM INTERFACE "${OPENCV_HEADERS}")
target_link_libraries(touchtrial_opencv INTERFACE "${OPENCV_IMGPROC}" "${OPENCV_CORE}")

# What reads pictures. libtiff has handlers of errors for each file from 4.5 on.
find_package(PNG REQUIRED)
find_package(JPEG REQUIRED)
find_package(TIFF 4.5 REQUIRED)
add_library(touchtrial_pictures INTERFACE)
target_link_libraries(touchtrial_pictures INTERFACE PNG::PNG JPEG::JPEG TIFF::TIFF)

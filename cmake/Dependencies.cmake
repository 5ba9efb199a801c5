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
pkg_check_modules(nettle REQUIRED IMPORTED_TARGET GLOBAL nettle)
pkg_check_modules(rapidjson REQUIRED RapidJSON)  # headers alone

# A newer libpqxx may bring a CMake package; pkg-config finds every version.
pkg_check_modules(libpqxx REQUIRED IMPORTED_TARGET GLOBAL libpqxx libpq)
# What one command alone needs should cost the others nothing (decision 47): libpqxx in the program
# and libpq, with TLS, Kerberos and LDAP behind it, loaded when a server is first asked for. The
# forwarders name the functions that libpqxx 6.4 calls; any other is linked as it comes.
find_library(PQXX_ARCHIVE libpqxx.a)
add_library(touchtrial_pqxx INTERFACE)
if(PQXX_ARCHIVE AND libpqxx_libpqxx_VERSION MATCHES "^6\\.4\\.")
  add_library(touchtrial_libpq STATIC)
  target_include_directories(touchtrial_libpq PRIVATE "${CMAKE_SOURCE_DIR}" ${libpqxx_INCLUDE_DIRS})
  target_link_libraries(touchtrial_libpq PRIVATE touchtrial_settings ${CMAKE_DL_LIBS})
  set_target_properties(touchtrial_libpq PROPERTIES CXX_VISIBILITY_PRESET hidden)
  target_include_directories(touchtrial_pqxx SYSTEM INTERFACE ${libpqxx_INCLUDE_DIRS})
  target_link_libraries(touchtrial_pqxx INTERFACE "${PQXX_ARCHIVE}" touchtrial_libpq)
else()
  target_link_libraries(touchtrial_pqxx INTERFACE PkgConfig::libpqxx)
endif()

pkg_check_modules(libusb REQUIRED IMPORTED_TARGET GLOBAL libusb-1.0)

find_package(glfw3 REQUIRED)
find_package(OpenGL REQUIRED)
# Debian's Dear ImGui holds the GLFW and OpenGL 3 backends, and leaves these two to whoever links it.
pkg_check_modules(imgui REQUIRED IMPORTED_TARGET GLOBAL imgui)
pkg_check_modules(freetype REQUIRED IMPORTED_TARGET GLOBAL freetype2)
# For its header: the library is loaded when sound is first wanted.
pkg_check_modules(portaudio REQUIRED portaudio-2.0)

# Highway's library calibrates a clock when it is loaded: of the series whose functions the forwarders
# name, it is loaded with the first kernel (decision 47).
pkg_check_modules(hwy REQUIRED IMPORTED_TARGET GLOBAL libhwy)
add_library(touchtrial_hwy INTERFACE)
if(hwy_VERSION MATCHES "^1\\.0\\." AND EXISTS "${hwy_LIBDIR}/libhwy.so.1" AND CMAKE_SIZEOF_VOID_P EQUAL 8)
  add_library(touchtrial_highway STATIC)
  target_include_directories(touchtrial_highway PRIVATE "${CMAKE_SOURCE_DIR}" ${hwy_INCLUDE_DIRS})
  target_link_libraries(touchtrial_highway PRIVATE touchtrial_settings ${CMAKE_DL_LIBS})
  target_include_directories(touchtrial_hwy SYSTEM INTERFACE ${hwy_INCLUDE_DIRS})
  target_link_libraries(touchtrial_hwy INTERFACE touchtrial_highway)
else()
  target_link_libraries(touchtrial_hwy INTERFACE PkgConfig::hwy)
endif()

# Only what OpenCV computes with: its own package file wants all of its modules installed, and what
# these bring along. Its headers warn under C++20; as a system target they stay quiet.
find_path(OPENCV_HEADERS opencv2/imgproc.hpp PATH_SUFFIXES opencv4 REQUIRED)
find_library(OPENCV_CORE opencv_core REQUIRED)
find_library(OPENCV_IMGPROC opencv_imgproc REQUIRED)
# Of the archives, where there are any that link, only what is called comes into the program; BLAS,
# LAPACK and GLX, which the shared libraries load at every start, are then needed by the benchmark's
# matrices alone (decision 47).
find_library(OPENCV_CORE_ARCHIVE libopencv_core.a)
find_library(OPENCV_IMGPROC_ARCHIVE libopencv_imgproc.a)
set(OPENCV_ARCHIVES "${OPENCV_IMGPROC_ARCHIVE}" "${OPENCV_CORE_ARCHIVE}" TBB::tbb ZLIB::ZLIB
    -Wl,--push-state,--as-needed -llapack -lblas -lGLX -Wl,--pop-state
    Threads::Threads ${CMAKE_DL_LIBS})
if(OPENCV_CORE_ARCHIVE AND OPENCV_IMGPROC_ARCHIVE)
  include(CheckCXXSourceCompiles)
  set(CMAKE_REQUIRED_INCLUDES "${OPENCV_HEADERS}")
  set(CMAKE_REQUIRED_LIBRARIES ${OPENCV_ARCHIVES})
  check_cxx_source_compiles("#include <opencv2/imgproc.hpp>
    int main() {
      cv::Mat a(9, 9, CV_8UC3, cv::Scalar(1, 2, 3)), b;
      cv::resize(a, b, cv::Size(4, 4), 0, 0, cv::INTER_AREA);
      cv::medianBlur(a, b, 3);
      cv::cvtColor(a, b, cv::COLOR_BGR2GRAY);
      cv::integral(b, a, CV_64F);
      cv::arrowedLine(b, {1, 1}, {2, 2}, cv::Scalar(1));
      cv::filter2D(b, a, CV_32F, b);
      cv::dft(a, b);
    }" OPENCV_ARCHIVES_LINK)
  unset(CMAKE_REQUIRED_INCLUDES)
  unset(CMAKE_REQUIRED_LIBRARIES)
endif()
add_library(touchtrial_opencv INTERFACE)
target_include_directories(touchtrial_opencv SYSTEM INTERFACE "${OPENCV_HEADERS}")
if(OPENCV_ARCHIVES_LINK)
  target_link_libraries(touchtrial_opencv INTERFACE ${OPENCV_ARCHIVES})
else()
  target_link_libraries(touchtrial_opencv INTERFACE "${OPENCV_IMGPROC}" "${OPENCV_CORE}")
endif()

# What reads pictures. libtiff has handlers of errors for each file from 4.5 on.
find_package(PNG REQUIRED)
find_package(JPEG REQUIRED)
find_package(TIFF 4.5 REQUIRED)
add_library(touchtrial_pictures INTERFACE)
# Their archives, and those of what libtiff unpacks with, where all of them link: ten libraries fewer
# to load at every start (decision 47).
set(PICTURE_ARCHIVES "")
foreach(name tiff webp Lerc jbig deflate lzma zstd jpeg png16 z)
  find_library(PICTURE_ARCHIVE_${name} lib${name}.a)
  list(APPEND PICTURE_ARCHIVES "${PICTURE_ARCHIVE_${name}}")
endforeach()
if(NOT PICTURE_ARCHIVES MATCHES "NOTFOUND")
  include(CheckCXXSourceCompiles)
  set(CMAKE_REQUIRED_LIBRARIES ${PICTURE_ARCHIVES} m Threads::Threads)
  check_cxx_source_compiles("#include <cstdio>
    #include <jpeglib.h>
    #include <png.h>
    #include <tiffio.h>
    int main() {
      jpeg_error_mgr errors;
      return TIFFOpen(\"a\", \"r\") == nullptr && jpeg_std_error(&errors) != nullptr &&
             png_access_version_number() != 0;
    }" PICTURE_ARCHIVES_LINK)
  unset(CMAKE_REQUIRED_LIBRARIES)
endif()
if(PICTURE_ARCHIVES_LINK)
  target_link_libraries(touchtrial_pictures INTERFACE ${PICTURE_ARCHIVES} m Threads::Threads)
else()
  target_link_libraries(touchtrial_pictures INTERFACE PNG::PNG JPEG::JPEG TIFF::TIFF)
endif()

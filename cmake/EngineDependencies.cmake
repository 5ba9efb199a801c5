# Third-party dependencies of core and engine. TOUCHTRIAL_NEED is REQUIRED or QUIET. Programs that use
# the installed engine also include this file, possibly from several folders
# (cmake/touchtrial-config.cmake.in).
find_package(PkgConfig ${TOUCHTRIAL_NEED})
find_package(Threads ${TOUCHTRIAL_NEED})
find_package(TBB ${TOUCHTRIAL_NEED})
find_package(ZLIB ${TOUCHTRIAL_NEED})
if(NOT COMMAND pkg_check_modules OR NOT TARGET TBB::tbb OR NOT TARGET ZLIB::ZLIB)
  return()
endif()
pkg_check_modules(fftw3 ${TOUCHTRIAL_NEED} IMPORTED_TARGET GLOBAL fftw3)
pkg_check_modules(fftw3f ${TOUCHTRIAL_NEED} IMPORTED_TARGET GLOBAL fftw3f)
pkg_check_modules(libsodium ${TOUCHTRIAL_NEED} IMPORTED_TARGET GLOBAL libsodium)
pkg_check_modules(nettle ${TOUCHTRIAL_NEED} IMPORTED_TARGET GLOBAL nettle)
pkg_check_modules(utf8proc ${TOUCHTRIAL_NEED} IMPORTED_TARGET GLOBAL libutf8proc)

# Highway's library calibrates a clock when it is loaded. If the forwarders cover all calls from its
# headers, it is loaded only with the first kernel (decision 47).
pkg_check_modules(hwy ${TOUCHTRIAL_NEED} IMPORTED_TARGET GLOBAL libhwy)
if(NOT TARGET touchtrial_hwy)
  add_library(touchtrial_hwy INTERFACE IMPORTED GLOBAL)
endif()
if(NOT DEFINED TOUCHTRIAL_HIGHWAY_LATER AND EXISTS "${hwy_LIBDIR}/libhwy.so.1")
  include(LinksWith)
  touchtrial_links_with(TOUCHTRIAL_HIGHWAY_LATER highway engine/kernels/highway/forwarders.cpp
                        INCLUDES ${hwy_INCLUDE_DIRS})
endif()
if(TOUCHTRIAL_HIGHWAY_LATER)  # engine/CMakeLists.txt makes touchtrial_highway, the forwarders
  target_include_directories(touchtrial_hwy SYSTEM INTERFACE ${hwy_INCLUDE_DIRS})
else()
  target_link_libraries(touchtrial_hwy INTERFACE PkgConfig::hwy)
endif()

# Only OpenCV's computing modules, because its own package file requires all modules and their
# dependencies. A system target suppresses the warnings of its headers under C++20.
find_path(OPENCV_HEADERS opencv2/imgproc.hpp PATH_SUFFIXES opencv4)
find_library(OPENCV_CORE opencv_core)
find_library(OPENCV_IMGPROC opencv_imgproc)
# Static archives are preferred if they link: only called code enters the program. Only the benchmark's
# matrices then need BLAS, LAPACK and GLX, which the shared libraries load at every start (decision 47).
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
if(NOT TARGET touchtrial_opencv)
  add_library(touchtrial_opencv INTERFACE IMPORTED GLOBAL)
endif()
target_include_directories(touchtrial_opencv SYSTEM INTERFACE "${OPENCV_HEADERS}")
if(OPENCV_ARCHIVES_LINK)
  target_link_libraries(touchtrial_opencv INTERFACE ${OPENCV_ARCHIVES})
else()
  target_link_libraries(touchtrial_opencv INTERFACE "${OPENCV_IMGPROC}" "${OPENCV_CORE}")
endif()

# Image readers are shared libraries, so that the system's security updates apply (decision 47). libtiff
# has error handlers for each file since 4.5.
find_package(PNG ${TOUCHTRIAL_NEED})
find_package(JPEG ${TOUCHTRIAL_NEED})
find_package(TIFF 4.5 ${TOUCHTRIAL_NEED})
pkg_check_modules(stb ${TOUCHTRIAL_NEED} IMPORTED_TARGET GLOBAL stb)
if(NOT TARGET touchtrial_pictures)
  add_library(touchtrial_pictures INTERFACE IMPORTED GLOBAL)
endif()
target_link_libraries(touchtrial_pictures INTERFACE PNG::PNG JPEG::JPEG TIFF::TIFF PkgConfig::stb)

# Everything that Touchtrial uses and did not write. The versions of Debian 12 and 13 serve.
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

# Whether a Python module is linked, not a program.
set(LINKS_A_MODULE "$<STREQUAL:$<TARGET_PROPERTY:TYPE>,MODULE_LIBRARY>")

# A newer libpqxx may bring a CMake package; pkg-config finds every version.
pkg_check_modules(libpqxx REQUIRED IMPORTED_TARGET GLOBAL libpqxx libpq)
# What one command alone needs should cost the others nothing (decision 47): libpqxx in the program
# and libpq, with TLS, Kerberos and LDAP behind it, loaded when a server is first asked for, where the
# forwarders have all that libpqxx calls. Any other libpqxx is linked as it comes.
find_library(PQXX_ARCHIVE libpqxx.a)
add_library(touchtrial_pqxx INTERFACE)
if(PQXX_ARCHIVE)
  include(LinksWith)
  touchtrial_links_with(TOUCHTRIAL_LIBPQ_LATER libpqxx protocols/collect/libpq/forwarders.cpp
                        INCLUDES ${libpqxx_INCLUDE_DIRS} LIBRARIES "${PQXX_ARCHIVE}")
endif()
if(TOUCHTRIAL_LIBPQ_LATER)
  add_library(touchtrial_libpq STATIC)
  target_include_directories(touchtrial_libpq PRIVATE "${CMAKE_SOURCE_DIR}" ${libpqxx_INCLUDE_DIRS})
  target_link_libraries(touchtrial_libpq PRIVATE touchtrial_settings ${CMAKE_DL_LIBS})
  set_target_properties(touchtrial_libpq PROPERTIES CXX_VISIBILITY_PRESET hidden
                                                    POSITION_INDEPENDENT_CODE ON)
  target_include_directories(touchtrial_pqxx SYSTEM INTERFACE ${libpqxx_INCLUDE_DIRS})
  # Debian's archive cannot be part of a shared library such as the Python module.
  target_link_libraries(touchtrial_pqxx INTERFACE
    "$<IF:${LINKS_A_MODULE},PkgConfig::libpqxx,${PQXX_ARCHIVE};touchtrial_libpq>")
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

# Debian packages of the installed components: `cpack` in the build folder, or scripts/package, which builds
# the documentation first. CPack makes them from the same build that serves a prefix, which avoids a
# second build by debhelper.
set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_COMPONENTS_ALL program postgres development)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_DIRECTORY "${CMAKE_BINARY_DIR}/packages")
set(CPACK_PACKAGE_NAME touchtrial)
set(TOUCHTRIAL_MAINTAINER "Touchtrial developers <touchtrial@users.noreply.github.com>" CACHE STRING
    "Name and address in the packages' fields")
set(CPACK_PACKAGE_CONTACT "${TOUCHTRIAL_MAINTAINER}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # would stand before each package's own
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS OFF)

# touchtrial_package(COMPONENT NAME SECTION DESCRIPTION [PARAGRAPH])
# Names the package of a component and sets the fields that all packages share.
macro(touchtrial_package component name section summary text)
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${summary}\n${text}")
  set(folder "${CMAKE_INSTALL_DATADIR}/doc/${name}")
  install(FILES cmake/packages/copyright "${CMAKE_BINARY_DIR}/package/changelog.Debian.gz"
          DESTINATION "${folder}" COMPONENT ${component})
  if(EXISTS "${CMAKE_SOURCE_DIR}/cmake/packages/${name}.lintian-overrides")
    install(FILES cmake/packages/${name}.lintian-overrides RENAME ${name}
            DESTINATION "${CMAKE_INSTALL_DATADIR}/lintian/overrides" COMPONENT ${component})
  endif()
endmacro()

# The packages target the building system.
set(TOUCHTRIAL_DISTRIBUTION unstable)
if(EXISTS /etc/os-release)
  file(STRINGS /etc/os-release codename REGEX "^VERSION_CODENAME=")
  string(REGEX REPLACE "^VERSION_CODENAME=|\"" "" TOUCHTRIAL_DISTRIBUTION "${codename}")
endif()
string(TIMESTAMP CHANGELOG_DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)
configure_file(cmake/packages/changelog.in "${CMAKE_BINARY_DIR}/package/changelog.Debian" @ONLY)
execute_process(COMMAND gzip -9nf "${CMAKE_BINARY_DIR}/package/changelog.Debian" COMMAND_ERROR_IS_FATAL ANY)

touchtrial_package(program touchtrial science "psychophysics runner for textures that are felt"
"Turns pictures into texture force fields, presents them blind through a
force-feedback device, records what participants answer in SQLite, and reports
how well they told the textures apart. Runs classification and comparison
studies, measures thresholds, simulates participants, plans the size of a
study, and exports to CSV, BIDS, Psych-DS and R.
.
The command demo runs simulated participants through two studies.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS
    "gnuplot-nox | gnuplot, touchtrial-postgres, libportaudio2, libgl1-mesa-dri, fonts-dejavu-core, fonts-droid-fallback")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "touchtrial-doc, python3-touchtrial, r-base-core")

touchtrial_package(postgres touchtrial-postgres science "sessions of Touchtrial on a PostgreSQL server"
"What the commands sync and merge load to send sessions to a server and to
fetch them from there.")
set(CPACK_DEBIAN_POSTGRES_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_POSTGRES_PACKAGE_DEPENDS "touchtrial (= ${PROJECT_VERSION}-1)")

touchtrial_package(development libtouchtrial-dev libdevel "engine of Touchtrial, for programs in C++"
"Pictures to textures to force fields, and the forces at a moving stylus: the
static library behind Touchtrial, with headers and a CMake package
(find_package(touchtrial), target touchtrial::engine).")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libopencv-core-dev, libopencv-imgproc-dev, libpng-dev, libjpeg-dev, libtiff-dev, libstb-dev, libfftw3-dev, libhwy-dev, libsodium-dev, nettle-dev, libutf8proc-dev, libtbb-dev, zlib1g-dev, pkgconf, cmake")

if(TOUCHTRIAL_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  touchtrial_package(python python3-touchtrial python "Touchtrial's engine and results in Python"
"Textures, force fields and forces along a path as NumPy arrays; an unblinded
study's trials, traces and report as arrays and data frames; simulated
studies.")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-pandas")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_STRICT_PERMISSION ON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA
      "${CMAKE_SOURCE_DIR}/cmake/packages/python3-touchtrial/postinst"
      "${CMAKE_SOURCE_DIR}/cmake/packages/python3-touchtrial/prerm")
  # The module is compiled for one version of Python.
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  set(touchtrial_python_depends "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), python3 (<< ${Python_VERSION_MAJOR}.${next_minor}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${touchtrial_python_depends}")
endif()

# Built by scripts/site.
set(site "${CMAKE_SOURCE_DIR}/build/site")
install(DIRECTORY "${site}/" DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/touchtrial-doc/html" COMPONENT doc OPTIONAL)
if(EXISTS "${site}/index.html")
  list(APPEND CPACK_COMPONENTS_ALL doc)
  touchtrial_package(doc touchtrial-doc doc "documentation of Touchtrial"
"The pages of Touchtrial's documentation as a site that needs no network: a
tutorial, guides, one page for each command, the mathematics of the method,
and the benchmarks.")
  install(FILES cmake/packages/touchtrial-doc.doc-base RENAME touchtrial-doc
          DESTINATION "${CMAKE_INSTALL_DATADIR}/doc-base" COMPONENT doc)
  set(CPACK_DEBIAN_DOC_PACKAGE_ARCHITECTURE all)
endif()

# The kernels and the rest are compiled for x86-64-v2 (cmake/CompilerSettings.cmake).
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "sse4.2-support")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${touchtrial_python_depends}, sse4.2-support")
endif()
if(TARGET touchtrial_highway)
  # Loaded at run time, so dpkg-shlibdeps does not detect it; its package has another name in Debian 13.
  set(highway_package libhwy1)
  file(REAL_PATH "${hwy_LIBDIR}/libhwy.so.1" highway_library)
  execute_process(COMMAND dpkg-query --search "${highway_library}" OUTPUT_VARIABLE found ERROR_QUIET)
  if(found MATCHES "^([a-z0-9.+-]+):")
    set(highway_package "${CMAKE_MATCH_1}")
  endif()
  list(APPEND CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "${highway_package}")
  list(JOIN CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS ", " CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS)
  string(APPEND CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS ", ${highway_package}")
endif()
include(CPack)

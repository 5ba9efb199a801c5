# The files that `cmake --install` installs, by component: program, postgres, doc, development (and
# python, in python/).
# Nothing depends on the prefix, so the installed tree can be moved. The packages are made of
# the same components: cmake/Packages.cmake.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME program)

install(TARGETS touchtrial RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT program)
# record/merging/bundle_module.cpp searches this path.
install(TARGETS touchtrial_postgres LIBRARY DESTINATION lib/touchtrial COMPONENT postgres)

# The example studies with the files that they name, for `touchtrial examples`
# (app/commands/shipped_files.cpp).
set(shipped "${CMAKE_INSTALL_DATADIR}/touchtrial")
install(DIRECTORY config/ DESTINATION "${shipped}/config" COMPONENT program
        FILES_MATCHING PATTERN "*.json" PATTERN "udev" EXCLUDE PATTERN "desktop" EXCLUDE PATTERN "completion" EXCLUDE PATTERN "*.pack" EXCLUDE)
install(DIRECTORY stimuli/ DESTINATION "${shipped}/stimuli" COMPONENT program
        FILES_MATCHING PATTERN "*.png" PATTERN "manifest.json"
        PATTERN "import" EXCLUDE PATTERN "objects" EXCLUDE PATTERN "textures" EXCLUDE)

file(GLOB rules CONFIGURE_DEPENDS "${CMAKE_SOURCE_DIR}/config/udev/*.rules")
install(FILES ${rules} DESTINATION lib/udev/rules.d COMPONENT program)

# The desktop entry opens a terminal, because the program is started from the command line.
install(FILES config/desktop/touchtrial.desktop
        DESTINATION "${CMAKE_INSTALL_DATADIR}/applications" COMPONENT program)
install(FILES config/desktop/io.github.touchtrial.metainfo.xml
        DESTINATION "${CMAKE_INSTALL_DATADIR}/metainfo" COMPONENT program)
install(FILES config/desktop/touchtrial.svg
        DESTINATION "${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps" COMPONENT program)

# Man pages and completions are generated from the program's command definitions.
set(reference "${CMAKE_BINARY_DIR}/reference")
add_custom_command(OUTPUT "${reference}/made"
  COMMAND "${CMAKE_COMMAND}" -E rm -rf "${reference}"
  COMMAND touchtrial reference --out "${reference}"
  COMMAND sh -c "gzip -9n reference/man/*.1"
  COMMAND "${CMAKE_COMMAND}" -E touch "${reference}/made"
  WORKING_DIRECTORY "${CMAKE_BINARY_DIR}" DEPENDS touchtrial VERBATIM)
add_custom_target(reference ALL DEPENDS "${reference}/made")
install(DIRECTORY "${reference}/man/" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT program)
install(FILES config/completion/touchtrial
        DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" COMPONENT program)
install(FILES config/completion/_touchtrial
        DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions" COMPONENT program)
install(FILES config/completion/touchtrial.fish
        DESTINATION "${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d" COMPONENT program)

install(DIRECTORY examples/engine/ DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/libtouchtrial-dev/examples"
        COMPONENT development)

# The engine for other programs: find_package(touchtrial). Headers that are marked as private are not
# installed, nor those of the kernels and Fourier transforms, which expose third-party libraries.
set(libraries touchtrial_core touchtrial_engine)
if(TARGET touchtrial_highway)
  list(APPEND libraries touchtrial_highway)
endif()
foreach(library IN LISTS libraries)
  string(REPLACE "touchtrial_" "" short "${library}")
  set_target_properties(${library} PROPERTIES EXPORT_NAME "${short}")
endforeach()
install(TARGETS ${libraries} EXPORT touchtrial_targets
        ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT development
        INCLUDES DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/touchtrial")
foreach(room core engine)
  file(GLOB_RECURSE headers RELATIVE "${CMAKE_SOURCE_DIR}" CONFIGURE_DEPENDS "${CMAKE_SOURCE_DIR}/${room}/*.hpp")
  list(FILTER headers EXCLUDE REGEX "^engine/(kernels|fourier)/")
  foreach(header IN LISTS headers)
    file(STRINGS "${CMAKE_SOURCE_DIR}/${header}" private REGEX "^/// .*[Pp]rivate to( |$)")
    if(NOT private)
      get_filename_component(folder "${header}" DIRECTORY)
      install(FILES "${header}" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/touchtrial/${folder}"
              COMPONENT development)
    endif()
  endforeach()
endforeach()
set(package "${CMAKE_INSTALL_LIBDIR}/cmake/touchtrial")
install(EXPORT touchtrial_targets NAMESPACE touchtrial:: FILE touchtrial-targets.cmake
        DESTINATION "${package}" COMPONENT development)
if(NOT TOUCHTRIAL_HIGHWAY_LATER)
  set(TOUCHTRIAL_HIGHWAY_LATER OFF)
endif()
configure_package_config_file(cmake/touchtrial-config.cmake.in
  "${CMAKE_BINARY_DIR}/package/touchtrial-config.cmake" INSTALL_DESTINATION "${package}")
write_basic_package_version_file("${CMAKE_BINARY_DIR}/package/touchtrial-config-version.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_BINARY_DIR}/package/touchtrial-config.cmake"
              "${CMAKE_BINARY_DIR}/package/touchtrial-config-version.cmake" cmake/EngineDependencies.cmake
        DESTINATION "${package}" COMPONENT development)

# Run by CPack when the files of all components are in place, before they are packed.
file(GLOB components LIST_DIRECTORIES true ${CPACK_TEMPORARY_DIRECTORY}/*)
foreach(tree IN LISTS components)
  get_filename_component(component ${tree} NAME)
  string(TOUPPER ${component} upper)
  set(package ${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  if(NOT IS_DIRECTORY ${tree}/usr OR NOT package)
    continue()
  endif()
  set(doc ${tree}/usr/share/doc/${package})
  file(MAKE_DIRECTORY ${doc})

  file(READ ${CPACK_POINTPLANE_SOURCE_DIR}/LICENSE license)
  string(REGEX REPLACE "^[^\n]*\n\nCopyright[^\n]*\n[^\n]*\n\n" "" license "${license}")
  string(REGEX REPLACE "\n\n" "\n.\n" license "${license}")
  string(REGEX REPLACE "\n([^\n])" "\n \\1" license "\n${license}")
  file(WRITE ${doc}/copyright
    "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\n"
    "Upstream-Name: pointplane\n\nFiles: *\nCopyright: 2026, the pointplane authors\n"
    "License: BSD-3-clause${license}")

  if(EXISTS ${doc}/LICENSE)  # documents link to it
    file(REMOVE ${doc}/LICENSE)
    file(CREATE_LINK copyright ${doc}/LICENSE SYMBOLIC)
  endif()

  string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
  file(WRITE ${doc}/changelog
    "pointplane (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium\n\n"
    "  * Version ${CPACK_PACKAGE_VERSION}; what is new is in CHANGELOG.md of pointplane-doc.\n\n"
    " -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
  file(GLOB pages ${tree}/usr/share/man/man1/*.1)
  execute_process(COMMAND gzip -9nf ${doc}/changelog ${pages} COMMAND_ERROR_IS_FATAL ANY)

  file(GLOB libraries ${tree}/usr/lib/*.a ${tree}/usr/lib/*/*.a)
  if(libraries)
    execute_process(COMMAND ${CPACK_POINTPLANE_STRIP} --strip-debug --remove-section=.comment
                    --remove-section=.note --enable-deterministic-archives ${libraries}
                    COMMAND_ERROR_IS_FATAL ANY)
  endif()
  # Symbols are gone already (CPACK_STRIP_FILES). The compiler's name is of no use to users.
  file(GLOB programs ${tree}/usr/bin/* ${tree}/usr/lib/python3/dist-packages/*.so)
  if(programs)
    execute_process(COMMAND ${CPACK_POINTPLANE_STRIP} --remove-section=.comment --remove-section=.note ${programs}
                    COMMAND_ERROR_IS_FATAL ANY)
  endif()
  # Not those of the umask under which packages are made.
  file(GLOB_RECURSE files LIST_DIRECTORIES true ${tree}/*)
  foreach(file IN LISTS files)
    if(IS_DIRECTORY ${file})
      file(CHMOD ${file} DIRECTORY_PERMISSIONS
           OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
    elseif(NOT file MATCHES "/usr/bin/")
      file(CHMOD ${file} FILE_PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
    endif()
  endforeach()
endforeach()

# cuscus_add_library(<name> SOURCES <file>... HEADERS <file>... [PUBLIC <target>...] [PRIVATE <target>...])
# One static library `cuscus_<name>`, alias cuscus::<name>; without SOURCES it is header-only.
# Headers are included as "folder/file.h" from the project's root. Each must compile by itself: one
# with a source of its name is the first that this includes, the others are compiled alone by
# all_verify_interface_header_sets.
function(cuscus_add_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;HEADERS;PUBLIC;PRIVATE")
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "cuscus_add_library(${name}): unexpected ${arg_UNPARSED_ARGUMENTS}")
  endif()
  set(target cuscus_${name})
  if(arg_SOURCES)
    add_library(${target} STATIC ${arg_SOURCES})
    set(paired)
    set(alone)
    foreach(header IN LISTS arg_HEADERS)
      string(REGEX REPLACE "\\.h$" ".cc" source ${header})
      if(source IN_LIST arg_SOURCES)
        list(APPEND paired ${header})
      else()
        list(APPEND alone ${header})
      endif()
    endforeach()
    target_sources(${target} PUBLIC
      FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${paired}
      FILE_SET alone TYPE HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${alone})
    set_target_properties(${target} PROPERTIES INTERFACE_HEADER_SETS_TO_VERIFY alone)
    target_link_libraries(${target} PUBLIC ${arg_PUBLIC}
      PRIVATE ${arg_PRIVATE} cuscus::build_flags)
  else()
    add_library(${target} INTERFACE)
    target_sources(${target} INTERFACE FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}
      FILES ${arg_HEADERS})
    target_link_libraries(${target} INTERFACE ${arg_PUBLIC})
  endif()
  add_library(cuscus::${name} ALIAS ${target})
endfunction()

# cuscus_add_program(<name> SOURCES <file>... LIBRARIES <target>...)
# One executable in <build>/bin.
function(cuscus_add_program name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;LIBRARIES")
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_LIBRARIES} cuscus::build_flags)
endfunction()

include("${CMAKE_CURRENT_LIST_DIR}/railstep-targets.cmake")
# It is written in C++ and needs nothing of C++ at run time, so a project without C++ may link it.
set_target_properties(railstep::railstep_online PROPERTIES
  IMPORTED_LINK_INTERFACE_LANGUAGES "C" IMPORTED_LINK_INTERFACE_LANGUAGES_NOCONFIG "C"
  IMPORTED_LINK_INTERFACE_LANGUAGES_RELEASE "C" IMPORTED_LINK_INTERFACE_LANGUAGES_DEBUG "C"
  IMPORTED_LINK_INTERFACE_LANGUAGES_RELWITHDEBINFO "C")
add_library(railstep::railstep ALIAS railstep::railstep_online)

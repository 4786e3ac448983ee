# SPDX-License-Identifier: GPL-3.0-or-later
# Compiler settings shared by every target of the project.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

find_program(PCBMESH_CCACHE ccache)
if(PCBMESH_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${PCBMESH_CCACHE})
endif()

# Same bytes on every CPU: no fused multiply-add behind our back.
add_compile_options(-ffp-contract=off)
if(PCBMESH_SANITIZE)
  add_compile_options(-fsanitize=${PCBMESH_SANITIZE} -fno-omit-frame-pointer -g)
  add_link_options(-fsanitize=${PCBMESH_SANITIZE})
endif()

function(pcbmesh_warnings target)
  if(PCBMESH_DEVELOPER)
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wconversion -Werror
                           -Wno-restrict)  # g++ 12 warns falsely about std::string concatenation at -O3 (GCC bug 105651)
  endif()
endfunction()

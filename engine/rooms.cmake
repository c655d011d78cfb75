# myriad_room(NAME [LINK targets…] [EXCEPT regex]): makes one library of a room, by convention instead of by list, so that
# a new kernel is a new folder and nothing else:
#   *.cpp            the room's library, myriad_NAME
#   *_ref.cpp        plain CPU twins, in myriad_NAME_ref: linked by tests and benches, never by the product
#   *_test.cpp       the room's tests, myriad_NAME_tests (Google Test)
#   FOLDER/X.comp    a kernel, compiled, checked and embedded under the name "FOLDER/X"
# Sources whose paths match EXCEPT's regular expression are left to the caller.
enable_language(ASM)
include(GoogleTest)

# Compiles one kernel to SPIR-V, tracking its includes, validates it, and appends it to the room's embedded table.
function(myriad_kernel source out_spv)
  get_filename_component(stem ${source} NAME_WE)
  get_filename_component(dir ${source} DIRECTORY)
  get_filename_component(folder ${dir} NAME)
  set(spv ${CMAKE_CURRENT_BINARY_DIR}/${folder}.${stem}.spv)
  add_custom_command(
    OUTPUT ${spv}
    COMMAND ${GLSLANG} --quiet --target-env vulkan1.3 -I${PROJECT_SOURCE_DIR}
            --depfile ${spv}.d -o ${spv} ${source}
    COMMAND ${SPIRV_VAL} --target-env vulkan1.3 --scalar-block-layout ${spv}
    DEPENDS ${source}
    DEPFILE ${spv}.d
    COMMENT "kernel ${folder}/${stem}"
    VERBATIM)
  set(${out_spv} ${spv} PARENT_SCOPE)
endfunction()

# Writes NAME_kernels.S (the bytes) and NAME_kernels.cpp (the table that engine::Program looks names up in).
function(myriad_embed_kernels room sources)
  set(asm ".section .rodata\n")
  set(externs "")
  set(rows "")
  set(spvs "")
  foreach(source ${sources})
    myriad_kernel(${source} spv)
    list(APPEND spvs ${spv})
    get_filename_component(stem ${source} NAME_WE)
    get_filename_component(dir ${source} DIRECTORY)
    get_filename_component(folder ${dir} NAME)
    set(symbol kernel_${folder}_${stem})
    string(APPEND asm ".balign 4\n.global ${symbol}_begin\n${symbol}_begin:\n.incbin \"${spv}\"\n.global ${symbol}_end\n${symbol}_end:\n")
    string(APPEND externs "extern const uint32_t ${symbol}_begin[], ${symbol}_end[];\n")
    string(APPEND rows "    {\"${folder}/${stem}\", ${symbol}_begin, ${symbol}_end},\n")
  endforeach()
  string(APPEND asm ".section .note.GNU-stack,\"\",@progbits\n")
  file(CONFIGURE OUTPUT ${room}_kernels.S CONTENT "${asm}" @ONLY)
  file(CONFIGURE OUTPUT ${room}_kernels.cpp @ONLY CONTENT
"#include \"engine/kernels.hpp\"
extern \"C\" {
${externs}}
namespace myriad::engine {
extern const KernelTable ${room}_kernels;
const KernelTable ${room}_kernels = {
${rows}};
}
")
  set_source_files_properties(${CMAKE_CURRENT_BINARY_DIR}/${room}_kernels.S PROPERTIES OBJECT_DEPENDS "${spvs}")
  target_sources(myriad_${room} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/${room}_kernels.S ${CMAKE_CURRENT_BINARY_DIR}/${room}_kernels.cpp)
endfunction()

function(myriad_room room)
  cmake_parse_arguments(ARG "" "EXCEPT" "LINK" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  set(refs ${sources})
  set(tests ${sources})
  list(FILTER refs INCLUDE REGEX "_ref\\.cpp$")
  list(FILTER tests INCLUDE REGEX "_test\\.cpp$")
  list(FILTER sources EXCLUDE REGEX "_(ref|test)\\.cpp$")
  list(FILTER sources EXCLUDE REGEX "/main\\.cpp$")
  if(ARG_EXCEPT)
    list(FILTER sources EXCLUDE REGEX "${ARG_EXCEPT}")
  endif()
  add_library(myriad_${room} STATIC ${sources})
  target_link_libraries(myriad_${room} PUBLIC ${ARG_LINK})
  file(GLOB_RECURSE kernels CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.comp)
  if(kernels)
    myriad_embed_kernels(${room} "${kernels}")
  endif()
  if(NOT sources AND NOT kernels)
    set_target_properties(myriad_${room} PROPERTIES LINKER_LANGUAGE CXX)
  endif()
  if(MYRIAD_TESTS)
    if(refs)
      add_library(myriad_${room}_ref STATIC ${refs})
      target_link_libraries(myriad_${room}_ref PUBLIC myriad_${room})
    endif()
    if(tests)
      add_executable(myriad_${room}_tests ${tests})
      target_link_libraries(myriad_${room}_tests PRIVATE myriad_${room} dep::gtest dep::gtest_main)
      target_compile_options(myriad_${room}_tests PRIVATE ${MYRIAD_TEST_OPTIONS})
      foreach(twins myriad_${room} ${ARG_LINK})  # its own twins, and those of the rooms it builds on
        if(TARGET ${twins}_ref)
          target_link_libraries(myriad_${room}_tests PRIVATE ${twins}_ref)
        endif()
      endforeach()
      gtest_discover_tests(myriad_${room}_tests TEST_PREFIX "${room}." DISCOVERY_MODE PRE_TEST
                           PROPERTIES TIMEOUT 600 SKIP_REGULAR_EXPRESSION "\\[  SKIPPED \\]")
    endif()
  endif()
endfunction()

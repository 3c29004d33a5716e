# What the programs under tests/gpu, tests/property and tests/golden share.
include_guard(GLOBAL)
add_library(penumbra_test_support STATIC
  ${CMAKE_CURRENT_LIST_DIR}/build_scene.h
  ${CMAKE_CURRENT_LIST_DIR}/pictures.h ${CMAKE_CURRENT_LIST_DIR}/pictures.cpp
  ${CMAKE_CURRENT_LIST_DIR}/sdf.h ${CMAKE_CURRENT_LIST_DIR}/sdf.cpp
  ${CMAKE_CURRENT_LIST_DIR}/shared_renderer.h ${CMAKE_CURRENT_LIST_DIR}/shared_renderer.cpp)
target_link_libraries(penumbra_test_support PUBLIC penumbra_core GTest::gtest PRIVATE penumbra_flags)

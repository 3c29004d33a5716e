# cmake -D OUT=file.cpp -D DIR=glsl -D FILES="a;b" -P embed_shaders.cmake
# Writes a C++ table of the shader files' names and texts.
set(text "// Generated from glsl/ by cmake/embed_shaders.cmake.\n#include \"core/gl/shader_source.h\"\n\n")
string(APPEND text "namespace penumbra::gl {\nnamespace {\nconst EmbeddedShader kShaders[] = {\n")
foreach(file IN LISTS FILES)
  file(READ "${DIR}/${file}" body)
  string(APPEND text "    {\"${file}\", R\"PENUMBRA_GLSL(${body})PENUMBRA_GLSL\"},\n")
endforeach()
string(APPEND text "};\n}  // namespace\n")
string(APPEND text "std::span<const EmbeddedShader> embedded_shaders() { return kShaders; }\n}  // namespace penumbra::gl\n")
file(WRITE "${OUT}.new" "${text}")
execute_process(COMMAND ${CMAKE_COMMAND} -E copy_if_different "${OUT}.new" "${OUT}")

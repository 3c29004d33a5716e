# cmake -D OUT=file.cpp -D DIR=docs -P embed_documents.cmake
# Documents that the service gives out, as strings.
set(text "// Generated from docs/ by cmake/embed_documents.cmake.\n#include \"server/http/documents.h\"\n\nnamespace penumbra {\n")
foreach(pair openapi_document=openapi.json scene_schema=scene.schema.json)
  string(REGEX MATCH "^[^=]*" function "${pair}")
  string(REGEX MATCH "[^=]*$" file "${pair}")
  file(READ "${DIR}/${file}" content)
  if(content MATCHES "\\)penumbra\"")
    message(FATAL_ERROR "${file} holds the end of a raw string")
  endif()
  string(APPEND text "std::string_view ${function}() {\n    return R\"penumbra(${content})penumbra\";\n}\n")
endforeach()
string(APPEND text "}  // namespace penumbra\n")
file(WRITE "${OUT}" "${text}")

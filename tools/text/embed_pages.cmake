# Writes a source file that holds the text of the Markdown files in PAGES, for message_pages().
string(CONCAT text "#include \"text/explanation.h\"\n\nnamespace railstep {\nnamespace {\n"
  "constexpr std::string_view kPages[] = {\n")
file(GLOB pages ${PAGES}/*.md)
foreach(page IN LISTS pages)
  file(READ ${page} content)
  string(APPEND text "    R\"page(${content})page\",\n")
endforeach()
string(APPEND text "};\n}  // namespace\n\n"
  "std::span<const std::string_view> message_pages() { return kPages; }\n\n"
  "}  // namespace railstep\n")
file(WRITE ${OUT} "${text}")

# Turns text files into one C++ source:
# cmake -DFILES=<list> -DOUTPUT=<file> -DHEADER=<header> -DNAMESPACE=<namespace> -P embed.cmake
# It defines template_text(name) of the namespace, which the header declares.
cmake_minimum_required(VERSION 3.25)
set(source "// Made by cmake/embed.cmake.\n#include \"${HEADER}\"\n\n#include <map>\n#include <stdexcept>\n\n")
string(APPEND source "namespace ${NAMESPACE} {\n\nconst std::string& template_text(const std::string& name) {\n")
string(APPEND source "  static const std::map<std::string, std::string> texts = {\n")
foreach(file ${FILES})
  get_filename_component(name ${file} NAME)
  file(READ ${file} text)
  string(APPEND source "      {\"${name}\", R\"~~~(${text})~~~\"},\n")
endforeach()
string(APPEND source "  };\n  const auto found = texts.find(name);\n")
string(APPEND source "  if (found == texts.end()) throw std::logic_error(\"no template \" + name);\n")
string(APPEND source "  return found->second;\n}\n\n}  // namespace ${NAMESPACE}\n")
file(WRITE ${OUTPUT} "${source}")

# Turns text files into one C++ source: cmake -DFILES=<list> -DOUTPUT=<file> -DHEADER=<header> -DNAMESPACE=<namespace>
# -P embed.cmake. It defines <namespace>::embedded_texts(), a map from file names to texts, which the header declares.
cmake_minimum_required(VERSION 3.25)
set(source "// Made from files at build time.\n#include \"${HEADER}\"\n\nnamespace ${NAMESPACE} {\n\n")
string(APPEND source "const std::map<std::string, std::string>& embedded_texts() {\n")
string(APPEND source "  static const std::map<std::string, std::string> texts = {\n")
foreach(file ${FILES})
  get_filename_component(name ${file} NAME)
  file(READ ${file} text)
  string(APPEND source "      {\"${name}\", R\"~~~(${text})~~~\"},\n")
endforeach()
string(APPEND source "  };\n  return texts;\n}\n\n}  // namespace ${NAMESPACE}\n")
file(WRITE ${OUTPUT} "${source}")

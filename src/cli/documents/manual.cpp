#include "manual.hpp"

#include <algorithm>
#include <cctype>

#include "description.hpp"

namespace polar::cli {

namespace {
constexpr const char* kExitCodes[][2] = {
    {"0", "done"},
    {"1", "some data sets of a batch failed; else a fault of the program: please report it"},
    {"2", "usage or configuration"},
    {"3", "input that cannot be read"},
    {"4", "files or folders that cannot be written"},
    {"5", "no particle could be registered"},
    {"6", "out of memory or threads"},
    {"128 + n", "ended by signal n"}};

// Text as it is to be seen: troff reads hyphens, backslashes and a line's first dot as something else.
std::string plain(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '-')
      out += "\\-";
    else if (c == '\\')
      out += "\\e";
    else
      out += c;
  }
  return !out.empty() && (out[0] == '.' || out[0] == '\'') ? "\\&" + out : out;
}

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

std::string heading(const std::string& name, const std::string& version) {
  return ".TH " + upper(plain(name)) + " 1 \"\" \"" + plain(version) + "\" \"polar manual\"\n.SH NAME\n" +
         plain(name) + " \\- ";
}

// The kind of value without what else the parser says of it: "INT in [0 - 4096]", "FLOAT".
std::string kind(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t colon = type.find(':');
  const std::string first = type.substr(0, colon);
  if (colon == std::string::npos || type.find(" in [", colon) == std::string::npos) return first;
  return type.substr(colon + 1);
}

std::string described(const CLI::Option& option) {
  std::string text = plain(option.get_description());
  std::string words;
  for (const std::string& word : choices(option)) words += (words.empty() ? ": " : ", ") + plain(word);
  return text + words;
}

std::string entry(const CLI::Option& option) {
  std::string line = ".TP\n";
  if (option.nonpositional()) {
    std::string names;
    for (const std::string& name : spellings(option))
      names += (names.empty() ? "\\fB" : ", \\fB") + plain(name) + "\\fR";
    line += names;
    if (takes_value(option)) line += " \\fI" + plain(kind(option)) + "\\fR";
  } else {
    line += "\\fI" + plain(option.get_name(true)) + "\\fR";
  }
  std::string excluded;
  for (const CLI::Option* other : option.get_excludes())
    excluded += (excluded.empty() ? " (not with " : ", ") + plain(other->get_name());
  return line + "\n" + described(option) + (excluded.empty() ? "" : excluded + ")") + "\n";
}

std::string entries(const std::string& title, const std::vector<const CLI::Option*>& options) {
  std::string out = options.empty() ? "" : ".SH " + title + "\n";
  for (const CLI::Option* option : options) out += entry(*option);
  return out;
}

std::string page_name(const CLI::App& subcommand) { return "polar-" + subcommand.get_name(); }
}  // namespace

std::string manual(const CLI::App& app, const std::string& version) {
  std::string text = app.get_description();
  text = text.substr(text.find(": ") + 2);  // after "polar: "
  std::string out = heading("polar", version) + plain(text) +
                    "\n.SH SYNOPSIS\n.B polar\n\\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n.SH COMMANDS\n";
  const auto commands = subcommands_of(app);
  for (const CLI::App* command : commands)
    out += ".TP\n\\fB" + plain(page_name(*command)) + "\\fR(1)\n" + plain(command->get_description()) + "\n";
  out += entries("OPTIONS", flags_of(app)) + ".SH EXIT STATUS\n";
  for (const auto& [code, meaning] : kExitCodes)
    out += ".TP\n\\fB" + std::string(code) + "\\fR\n" + meaning + "\n";
  out += ".SH SEE ALSO\n";
  for (const CLI::App* command : commands)
    out += "\\fB" + plain(page_name(*command)) + "\\fR(1)" + (command == commands.back() ? "\n" : ",\n");
  return out;
}

std::string manual_of(const CLI::App& subcommand, const std::string& version) {
  std::string out = heading(page_name(subcommand), version) + plain(subcommand.get_description()) +
                    "\n.SH SYNOPSIS\n.B polar " + plain(subcommand.get_name()) + "\n[\\fIOPTIONS\\fR]";
  for (const CLI::Option* option : positionals_of(subcommand)) {
    const std::string name = "\\fI" + plain(option->get_name(true)) + "\\fR";
    out += option->get_required() ? " " + name : " [" + name + "]";
  }
  return out + "\n" + entries("ARGUMENTS", positionals_of(subcommand)) +
         entries("OPTIONS", flags_of(subcommand)) + ".SH SEE ALSO\n\\fBpolar\\fR(1)\n";
}

}  // namespace polar::cli

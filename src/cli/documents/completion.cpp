#include "completion.hpp"

#include "description.hpp"

namespace polar::cli {

namespace {
std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : between) + word;
  return out;
}

std::vector<std::string> all_spellings(const CLI::App& app) {
  std::vector<std::string> out;
  for (const CLI::Option* option : flags_of(app))
    for (const std::string& name : spellings(*option)) out.push_back(name);
  return out;
}

std::vector<std::string> names_of(const std::vector<const CLI::App*>& commands) {
  std::vector<std::string> out;
  for (const CLI::App* command : commands) out.push_back(command->get_name());
  return out;
}

// In single quotes of a shell, with what zsh's _arguments and _describe would read as their own.
std::string quoted(const std::string& text, const std::string& special) {
  std::string out;
  for (const char c : text) {
    if (c == '\'')
      out += "'\\''";
    else if (special.find(c) != std::string::npos)
      out += std::string("\\") + c;
    else
      out += c;
  }
  return out;
}

std::string zsh_argument(const CLI::Option& option, const std::string& spelling) {
  std::string out = " \\\n        '*" + spelling + "[" + quoted(option.get_description(), "[]\\:") + "]";
  if (takes_value(option)) {
    const std::vector<std::string> words = choices(option);
    out += ":value:" + (words.empty() ? "_files" : "(" + joined(words, " ") + ")");
  }
  return out + "'";
}
}  // namespace

std::string bash_completion(const CLI::App& app) {
  const auto commands = subcommands_of(app);
  std::string options, values;
  for (const CLI::App* command : commands) {
    options += "    " + command->get_name() + ") words='" + joined(all_spellings(*command), " ") + "' ;;\n";
    for (const CLI::Option* option : flags_of(*command)) {
      std::vector<std::string> cases;
      for (const std::string& name : spellings(*option))
        cases.push_back("'" + command->get_name() + " " + name + "'");
      const std::vector<std::string> words = choices(*option);
      if (takes_value(*option))  // without words: nothing of ours, so that bash offers files
        values += "    " + joined(cases, "|") + ") words='" + joined(words, " ") + "' value=1 ;;\n";
    }
  }
  return "# bash completion of polar, made from its command line.\n"
         "_polar() {\n"
         "  local current=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]} words='' value=''\n"
         "  COMPREPLY=()\n"
         "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
         "    COMPREPLY=($(compgen -W '" +
         joined(names_of(commands), " ") + " " + joined(all_spellings(app), " ") +
         "' -- \"$current\"))\n"
         "    return\n"
         "  fi\n"
         "  case \"$command ${COMP_WORDS[COMP_CWORD-1]}\" in\n" +
         values +
         "  esac\n"
         "  if [ -z \"$value\" ] && [ \"${current#-}\" != \"$current\" ]; then\n"
         "    case \"$command\" in\n" +
         options +
         "    esac\n"
         "  fi\n"
         "  COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
         "}\n"
         "complete -o default -F _polar polar\n";
}

std::string zsh_completion(const CLI::App& app) {
  std::string commands, cases;
  for (const CLI::App* command : subcommands_of(app)) {
    commands += "    '" + command->get_name() + ":" + quoted(command->get_description(), ":\\") + "'\n";
    cases += "    " + command->get_name() + ")\n      _arguments";
    for (const CLI::Option* option : flags_of(*command))
      for (const std::string& name : spellings(*option)) cases += zsh_argument(*option, name);
    cases += " \\\n        '*:file:_files' ;;\n";
  }
  std::string options;
  for (const std::string& name : all_spellings(app)) options += " " + name;
  return "#compdef polar\n"
         "# zsh completion of polar, made from its command line.\n"
         "_polar() {\n"
         "  local -a commands\n"
         "  commands=(\n" +
         commands +
         "  )\n"
         "  if (( CURRENT == 2 )); then\n"
         "    _describe command commands\n"
         "    compadd --" +
         options +
         "\n"
         "    return\n"
         "  fi\n"
         "  local command=$words[2]\n"
         "  shift words\n"
         "  (( CURRENT-- ))\n"
         "  case $command in\n" +
         cases +
         "  esac\n"
         "}\n"
         "_polar \"$@\"\n";
}

}  // namespace polar::cli

#include "cli/completion.h"

#include <algorithm>
#include <sstream>

namespace grinder {

namespace {

constexpr const char* kHead = R"(# bash completion for grind: source <(rosrun flute_grinder grind completion bash)

_grind_words() {
  mapfile -t COMPREPLY < <(compgen -W "$1" -- "$2")
}

# Files of an extension (none for all, / for no file) and folders.
_grind_files() {
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen -f ${1:+-X "!*.$1"} -- "$2"; [ -z "$1" ] || compgen -d -- "$2")
}

# From the word that is grind on.
_grind_from() {
  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]} command='' i
  if [ "$cur" = = ]; then
    cur=''
  elif [ "$prev" = = ]; then
    prev=${COMP_WORDS[COMP_CWORD-2]}
  fi
  for ((i = $1 + 1; i < COMP_CWORD; i++)); do
    # Commands that have commands of their own.
    case ":$command" in
)";

constexpr const char* kWord = R"(      *) break ;;
    esac
    case ${COMP_WORDS[i-1]}:${COMP_WORDS[i]} in
)";

constexpr const char* kTail = R"(  esac
}

_grind() {
  _grind_from 0
}

_grind_rosrun() {
  if [ "${COMP_WORDS[1]} ${COMP_WORDS[2]}" = 'flute_grinder grind' ] && [ "$COMP_CWORD" -gt 2 ]; then
    _grind_from 2
  elif [ -n "$_grind_other_rosrun" ]; then
    "$_grind_other_rosrun" "$@"
  fi
}

complete -F _grind grind
# rosbash's, which bash-completion may have to load first.
complete -p rosrun &>/dev/null || _completion_loader rosrun &>/dev/null
if ! complete -p rosrun 2>/dev/null | grep -q _grind_rosrun; then
  _grind_other_rosrun=$(complete -p rosrun 2>/dev/null | sed -n 's/.*-F \([^ ]*\).*/\1/p')
fi
complete -F _grind_rosrun rosrun
)";

std::vector<const CLI::App*> subcommands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

bool takesValue(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// The names of an option, e.g. `-h` and `--help`.
std::vector<std::string> namesOf(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

/// The shell command that completes an argument.
std::string completer(const CLI::Option& option) {
  std::string type = option.get_type_name();
  if (type == kAnyFile) return "_grind_files '' \"$cur\"";
  if (type == kYamlFile) return "_grind_files yaml \"$cur\"";
  if (type == kUrdfFile) return "_grind_files urdf \"$cur\"";
  if (type == kFolder) return "_grind_files / \"$cur\"";
  if (type.front() != '{') return "COMPREPLY=()";
  std::replace(type.begin(), type.end(), '|', ' ');
  return "_grind_words '" + type.substr(1, type.size() - 2) + "' \"$cur\"";
}

/// Writes the patterns of the arguments of a command's options, each with its completion.
void writeValues(const CLI::App& app, const std::string& command, std::ostream& script) {
  for (const CLI::Option* option : app.get_options()) {
    if (!takesValue(*option)) continue;
    for (const std::string& name : namesOf(*option)) {
      script << "    '" << command << ' ' << name << " '*) " << completer(*option) << " ;;\n";
    }
  }
}

/// Writes the completion of a command's words other than arguments of options.
void writeWords(const CLI::App& app, const std::string& command, std::ostream& script) {
  std::string options, words;
  std::string positional;  // the first positional argument
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : namesOf(*option)) options += (options.empty() ? "" : " ") + name;
    if (option->get_positional() && positional.empty()) positional = completer(*option);
  }
  if (positional.empty()) positional = "COMPREPLY=()";
  for (const CLI::App* sub : subcommands(app)) words += (words.empty() ? "" : " ") + sub->get_name();
  if (!words.empty()) positional = "_grind_words '" + words + "' \"$cur\"";
  script << "    '" << command << " '*' -'*) _grind_words '" << options << "' \"$cur\" ;;\n"
         << "    '" << command << " '*) " << positional << " ;;\n";
}

void writeCommand(const CLI::App& app, const std::string& command, std::ostream& script) {
  writeValues(app, command, script);
  writeWords(app, command, script);
}

}  // namespace

std::string bashCompletion(const CLI::App& app) {
  std::ostringstream script;
  script << kHead << "      :";
  for (const CLI::App* sub : subcommands(app)) {
    if (!subcommands(*sub).empty()) script << " | :" << sub->get_name();
  }
  script << ") ;;\n" << kWord;
  // Skip the argument of an option before the sub-command.
  for (const CLI::Option* option : app.get_options()) {
    if (!takesValue(*option)) continue;
    for (const std::string& name : namesOf(*option)) script << "      " << name << ":*) ;;\n";
  }
  script << "      *:-* | *:= | =:*) ;;\n      *) command=${command:+$command }${COMP_WORDS[i]} ;;\n    esac\n  done\n"
         << "  case \"$command $prev $cur\" in\n";
  writeValues(app, "", script);
  for (const CLI::App* sub : subcommands(app)) {
    for (const CLI::App* inner : subcommands(*sub))
      writeCommand(*inner, sub->get_name() + " " + inner->get_name(), script);
    writeCommand(*sub, sub->get_name(), script);
  }
  writeWords(app, "", script);
  script << kTail;
  return script.str();
}

}  // namespace grinder

// dbd completion, dbd man: what the shell and `man` know of the commands, from the parser's tables.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>

#include "app/base/build_info.h"
#include "app/base/console.h"
#include "app/commands/commands.h"
#include "scenes/joined.h"

namespace app {

namespace {

constexpr const char* kShells[] = {"bash", "zsh", "fish"};

bool takesScene(const CLI::App& command) {
  const CLI::Option* scene = command.get_option_no_throw("SCENE");
  return scene != nullptr || command.get_option_no_throw("scene") != nullptr;
}

// What may follow a command: other commands, options, scenes of the library.
std::vector<std::string> follows(const CLI::App& command) {
  std::vector<std::string> words = longNames(command);
  for (const CLI::App* next : command.get_subcommands({})) words.push_back(next->get_name());
  if (takesScene(command)) {
    for (const std::string& scene : scenes::libraryScenes()) words.push_back(scene);
  }
  return words;
}

using Visit = std::function<void(const CLI::App&, const std::string& path)>;

// Every command below, "study" before "study accuracy".
void visitAll(const CLI::App& command, const std::string& path, const Visit& visit) {
  for (const CLI::App* next : command.get_subcommands({})) {
    const std::string here = path.empty() ? next->get_name() : path + " " + next->get_name();
    visit(*next, here);
    visitAll(*next, here, visit);
  }
}

std::string bashScript(const CLI::App& line) {
  std::string cases;
  visitAll(line, "", [&](const CLI::App& command, const std::string& path) {
    const std::size_t space = path.rfind(' ');
    const std::string before = space == std::string::npos ? "" : path.substr(0, space);
    cases += fmt::format("      '{} {}') command='{}'; known='{}';;\n", before, command.get_name(),
                         path, scenes::joined(follows(command), " "));
  });
  return fmt::format(
      "# dbd completion bash > /etc/bash_completion.d/dbd\n"
      "_dbd() {{\n"
      "  local word command='' known='{}'\n"
      "  local current=\"${{COMP_WORDS[COMP_CWORD]}}\"\n"
      "  for word in \"${{COMP_WORDS[@]:1:COMP_CWORD-1}}\"; do\n"
      "    case \"$command $word\" in\n{}    esac\n"
      "  done\n"
      "  COMPREPLY=($(compgen -W \"$known\" -- \"$current\"))\n"
      "  [ ${{#COMPREPLY[@]}} -gt 0 ] || COMPREPLY=($(compgen -f -- \"$current\"))\n"
      "}}\n"
      "complete -F _dbd dbd\n",
      scenes::joined(follows(line), " "), cases);
}

std::string summaryOf(const std::string& text) { return text.substr(0, text.find('\n')); }

std::string quotedForFish(const std::string& text) {
  std::string quoted;
  for (const char c : text) {
    if (c == '\'' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return "'" + quoted + "'";
}

std::string fishScript(const CLI::App& line) {
  std::string script = "# dbd completion fish > ~/.config/fish/completions/dbd.fish\n";
  visitAll(line, "", [&](const CLI::App& command, const std::string& path) {
    const std::size_t space = path.rfind(' ');
    const std::string where = space == std::string::npos
                                  ? "__fish_use_subcommand"
                                  : "__fish_seen_subcommand_from " + path.substr(0, space);
    script += fmt::format("complete -c dbd -n '{}' -a {} -d {}\n", where, command.get_name(),
                          quotedForFish(summaryOf(command.get_description())));
    const std::string here = "__fish_seen_subcommand_from " + command.get_name();
    for (const CLI::Option* option : command.get_options()) {
      for (const std::string& name : option->get_lnames()) {
        script += fmt::format("complete -c dbd -n '{}' -l {} -d {}\n", here, name,
                              quotedForFish(summaryOf(option->get_description())));
      }
    }
  });
  return script;
}

std::string forRoff(const std::string& text) {
  std::string safe;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\\') safe += "\\e";
    const bool begins = i == 0 || text[i - 1] == '\n';
    if (begins && (text[i] == '.' || text[i] == '\'')) safe += "\\&";
    if (text[i] == '-') {
      safe += "\\-";
    } else if (text[i] != '\\') {
      safe += text[i];
    }
  }
  return safe;
}

std::string manPage(const CLI::App& line) {
  std::string page = fmt::format(
      ".TH DBD 1 \"\" \"dbd {}\"\n.SH NAME\ndbd \\- displacement based dynamics\n.SH SYNOPSIS\n"
      ".B dbd\n.I COMMAND\n[options]\n.SH DESCRIPTION\n{}\n.SH COMMANDS\n",
      version(), forRoff(line.get_description()));
  visitAll(line, "", [&](const CLI::App& command, const std::string& path) {
    page += fmt::format(".SS dbd {}\n{}\n", forRoff(path), forRoff(command.get_description()));
    for (const CLI::Option* option : command.get_options()) {
      const std::string name = option->get_name(false, true);
      const std::string type = option->get_type_name();
      page +=
          fmt::format(".TP\n.B {}{}\n{}\n", forRoff(name.empty() ? option->get_name() : name),
                      type.empty() ? "" : " " + forRoff(type), forRoff(option->get_description()));
    }
  });
  return page + ".SH EXIT STATUS\n" + forRoff(line.get_footer()) + "\n";
}

}  // namespace

void addCompletion(CLI::App& line, Action& action) {
  auto shell = std::make_shared<std::string>();
  CLI::App* completion = line.add_subcommand(
      "completion", "Print what makes a shell complete commands, options and scenes");
  completion->add_option("SHELL", *shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember(std::vector<std::string>(std::begin(kShells), std::end(kShells))));
  completion->callback([&line, &action, shell] {
    action = [&line, shell] {
      const std::string start =
          *shell == "zsh" ? "autoload -U +X bashcompinit && bashcompinit\n" : "";
      say(*shell == "fish" ? fishScript(line) : start + bashScript(line));
      return ExitCode::kDone;
    };
  });
  CLI::App* man = line.add_subcommand("man", "Print the manual page: dbd man | man -l -");
  man->callback([&line, &action] {
    action = [&line] {
      say(manPage(line));
      return ExitCode::kDone;
    };
  });
}

}  // namespace app

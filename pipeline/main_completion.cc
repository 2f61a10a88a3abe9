// glint-completion: scripts for shells.
#include "base/programs/program.h"
#include "pipeline/driver/completion.h"

int main(int argc, char** argv) {
  std::string shell;
  glint::OptionSet options;
  options.AddPositional("SHELL", &shell, "bash, zsh or fish", true);
  return glint::RunProgram(
      argc, argv,
      {"glint-completion",
       "Prints a shell completion script for Glint's verbs, options, values and files.",
       GLINT_VERSION,
       "Examples:\n"
       "  glint completion bash > ~/.local/share/bash-completion/completions/glint\n"
       "  glint completion zsh > ~/.zfunc/_glint        # with fpath+=~/.zfunc\n"
       "  glint completion fish > ~/.config/fish/completions/glint.fish",
       false},
      &options, [&](const glint::CommonOptions&) -> glint::ProgramResult {
        const std::string script = glint::CompletionScript(shell, glint::DescribeCommands());
        return {script, {{"shell", shell}, {"script", script}}};
      });
}

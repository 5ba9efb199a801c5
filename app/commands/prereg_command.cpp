// prereg: writes the preregistration page of a study.
#include "app/commands/commands.hpp"
#include "app/commands/study_inputs.hpp"
#include "app/terminal/console.hpp"
#include "core/draft.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/outputs.hpp"
#include "protocols/session/commitment.hpp"
#include "study/prepare.hpp"
#include "study/protocol.hpp"

#include <filesystem>
#include <string>

#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct PreregArguments {
  fs::path study;
  fs::path pack;
  fs::path key;
  fs::path output;
};

int preregister(const PreregArguments& arguments) {
  const study::Study study = study::load_study(arguments.study);
  study::PackPlace place = pack_place_for(arguments.study, arguments.pack);
  if (!arguments.key.empty()) place.key = arguments.key;
  if (!path_exists(place.key) || !path_exists(place.pack)) {
    throw UsageError(
        arguments.study.string() +
        ": is not prepared; run `touchtrial prepare` first, or name the pack and the key "
        "with --pack and --key");
  }
  refuse_link(arguments.output);
  if (!arguments.output.empty() && path_exists(arguments.output)) {
    throw UsageError(arguments.output.string() +
                     ": exists already and may have been deposited; choose another name");
  }
  const study::StudyKey key = study::load_study_key(place.key);
  const engine::Pack pack(place.pack);
  session::require_prepared(study, key, place.key, pack);
  for (const std::string& missing : session::missing_statements(study.registration)) {
    // Only studies with a choice of classes have a checkable estimand.
    if (missing == "/registration/estimand" && !study::chooses_classes(study)) continue;
    spdlog::warn("{}: {} is not stated; add it before depositing the page",
                 arguments.study.string(), missing);
  }
  const std::string page = session::registration_page(key, pack);
  if (arguments.output.empty()) {
    print(page);
  } else {
    write_output(arguments.output, page);
  }
  return 0;
}

}  // namespace

void add_prereg_command(CLI::App& program, Action& action) {
  const auto [command, arguments] = add_command(
      program, action, "prereg",
      "Write the preregistration page to deposit before the first participant", preregister);
  add_study_argument(command, arguments.study);
  add_pack_option(command, arguments.pack);
  add_key_option(command, arguments.key, "Key of the study (default: beside the pack)");
  command.add_option("-o,--output", arguments.output,
                     "Markdown file to write (default: standard output)");
}

}  // namespace touchtrial::app

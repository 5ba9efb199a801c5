/// \file A study of three textures in its own folder, for tests that run the program.
#pragma once

#include "app/touchtrial_process.hpp"
#include "core/files.hpp"
#include "core/random.hpp"
#include "engine/image_file.hpp"
#include "support/temp_folder.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial {

using nlohmann::json;
namespace fs = std::filesystem;

/// Rough noise, smooth noise and stripes: three textures that a hand can distinguish.
inline GreyImage texture_number(int number) {
  RandomStream random(7, "study test", static_cast<std::uint64_t>(number));
  GreyImage image(120, 120);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const auto noise = static_cast<int>(random.below(number == 0 ? 200 : 20));
      const int stripes = number == 2 ? 120 * ((x / 9) % 2) : 60 * ((x / 3 + y / 3) % 2);
      image.at(y, x) = static_cast<std::uint8_t>(number == 0 ? noise : 40 + stripes + noise);
    }
  }
  return image;
}

inline const std::vector<std::string> kLabels = {"granite", "linen", "corduroy"};

inline json study_of(const std::string& protocol) {
  json classes = json::array();
  for (const std::string& label : kLabels) {
    classes.push_back({{"label", label}, {"images", {label + "-photo.png"}}});
  }
  json methods = json::array({{{"name", "adaptive"}}});
  if (protocol == "comparison") methods.push_back({{"name", "fixed"}, {"order", 0.3}});
  return {{"study", "cloths"},
          {"protocol", protocol},
          {"classes", classes},
          {"methods", methods},
          {"trials",
           {{"repeats", 2},
            {"explore_limit_s", 2.0},
            {"validity", {{"exploring_s", 2.0}, {"contact_s", 2.0}}}}},
          {"seed", 11}};
}

/// A folder in which the program is run.
struct ProgramFolder {
  [[nodiscard]] const fs::path& path() const { return folder.path(); }
  [[nodiscard]] std::string in(const std::string& name) const { return (path() / name).string(); }

  ProgramResult run(const std::vector<std::string>& arguments,
                    const std::string& input = "") const {
    return run_touchtrial(path(), arguments, input);
  }
  /// A line as it is typed, "close @study.db --yes": see typed_words.
  /// \param more  further words
  /// \param input  as for run_touchtrial
  [[nodiscard]] ProgramResult type(const std::string& line,
                                   const std::vector<std::string>& more = {},
                                   const std::string& input = "") const {
    std::vector<std::string> words = typed_words(line, path());
    words.insert(words.end(), more.begin(), more.end());
    return run(words, input);
  }
  /// The same; fails the test unless it succeeds.
  ProgramResult done(const std::string& line, const std::vector<std::string>& more = {}) const {
    return succeeded(type(line, more));
  }
  /// The object that such a line prints with --json.
  [[nodiscard]] json printed(const std::string& line,
                             const std::vector<std::string>& more = {}) const {
    return json::parse(done(line, more).output);
  }

  TempFolder folder;
};

/// A folder with a study file, its pictures, and a quick subject.
struct StudyFolder : ProgramFolder {
  explicit StudyFolder(const std::string& protocol = "classification") {
    for (std::size_t i = 0; i < kLabels.size(); ++i) {
      engine::write_png(path() / (kLabels[i] + "-photo.png"), texture_number(static_cast<int>(i)));
    }
    replace_file(path() / "cloths.json", study_of(protocol).dump());
    replace_file(path() / "quick.json",
                 R"({"feature_noise": 0.1, "explore_s": 1.5, "training_passes": 2})");
  }
  /// Writes the study file with these members in place of its own, or beside them.
  void write_study(const json& members, const std::string& file = "cloths.json") const {
    json study = study_of("classification");
    study.update(members, true);
    replace_file(path() / file, study.dump());
  }
  /// A whole session of a simulated participant, in virtual time.
  [[nodiscard]] ProgramResult session(const std::string& participant,
                                      const std::vector<std::string>& more = {},
                                      const std::string& db = "study.db") const {
    return type("run @cloths.json --participant '" + participant + "' --db @" + db +
                    " --subject @quick.json",
                more);
  }
  ProgramResult simulate(const std::string& db, const std::vector<std::string>& more = {},
                         const std::string& seed = "3") const {
    return type("simulate @cloths.json --participants 4 --subject @quick.json --db @" + db +
                    " --seed '" + seed + "'",
                more);
  }
};

inline std::string content(const fs::path& path) {
  return text_of(read_file(path));
}

}  // namespace touchtrial

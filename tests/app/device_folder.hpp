/// \file A folder in which commands of `device` are run.
#pragma once

#include "app/study_folder.hpp"
#include "support/child_process.hpp"

namespace touchtrial {

/// Has settings of its own, devices.json, so that the user's settings do not matter.
struct DeviceFolder : ProgramFolder {
  explicit DeviceFolder(const json& settings = json::object()) {
    replace_file(path() / "devices.json", settings.dump());
  }
  /// The words of `touchtrial device LINE` with these settings: see typed_words.
  [[nodiscard]] std::vector<std::string> words(const std::string& line) const {
    return typed_words("device " + line + " --settings @devices.json", path());
  }
  [[nodiscard]] ProgramResult device(const std::string& line) const { return run(words(line)); }
  /// The same beside the test, in this folder.
  [[nodiscard]] testing::ChildProcess start(
      const std::string& line, const std::vector<std::string>& environment = {}) const {
    std::vector<std::string> all = words(line);
    all.insert(all.begin(), TOUCHTRIAL_PROGRAM);
    return {all, environment, path().string()};
  }
  /// The object in a file of the folder.
  [[nodiscard]] json object_in(const std::string& file) const {
    return json::parse(text_of(read_file(path() / file)));
  }
};

}  // namespace touchtrial

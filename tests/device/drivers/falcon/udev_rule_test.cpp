#include "core/files.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/temp_folder.hpp"

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

namespace touchtrial {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = TOUCHTRIAL_SOURCE_DIR;
constexpr auto kRule = "60-touchtrial-falcon.rules";

std::string text_of(const fs::path& file) {
  const auto bytes = read_file(file);
  return {bytes.begin(), bytes.end()};
}

struct Outcome {
  int status = -1;
  std::string output;
};

Outcome install(const std::string& arguments) {
  const std::string script = (kSource / "scripts/install-udev-rules").string();
  FILE* const pipe = popen(("'" + script + "' " + arguments + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return {};
  Outcome outcome;
  std::array<char, 256> bytes{};
  while (std::fgets(bytes.data(), static_cast<int>(bytes.size()), pipe) != nullptr) {
    outcome.output += bytes.data();
  }
  outcome.status = pclose(pipe);
  return outcome;
}

TEST_CASE("the udev rule is installed once, repaired if it was changed, and reported each time") {
  const TempFolder folder;
  const std::string root = "--root '" + folder.path().string() + "'";
  const fs::path installed = folder.path() / "etc/udev/rules.d" / kRule;
  const std::string rule = text_of(kSource / "config/udev" / kRule);

  const Outcome first = install(root);
  CHECK(first.status == 0);
  CHECK_THAT(first.output, names(" " + installed.string()));
  CHECK(text_of(installed) == rule);
  CHECK_THAT(install(root).output, names(installed.string()));

  replace_file(installed, "# somebody's own\n");
  CHECK_THAT(install(root).output, names(" " + installed.string()));
  CHECK(text_of(installed) == rule);
}

TEST_CASE("a relative root of the udev rule starts at the caller's folder") {
  const TempFolder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  CHECK(install("--root package").status == 0);
  fs::current_path(before);
  CHECK(fs::exists(folder.path() / "package/etc/udev/rules.d" / kRule));
}

TEST_CASE("the udev rule names only the Falcon") {
  const std::string rule = text_of(kSource / "config/udev" / kRule);
  CHECK_THAT(rule, holds_text("ATTR{idVendor}==\"0403\", ATTR{idProduct}==\"cb48\""));
  CHECK_THAT(rule, holds_text("TAG+=\"uaccess\""));
  CHECK(rule.find("MODE=\"0666\"") == std::string::npos);
}

TEST_CASE(
    "the udev rule of Force Dimension names the maker's devices alone, and is installed too") {
  constexpr auto kName = "60-touchtrial-force-dimension.rules";
  const std::string rule = text_of(kSource / "config/udev" / kName);
  CHECK_THAT(rule, holds_text("ATTR{idVendor}==\"1451\""));
  CHECK_THAT(rule, holds_text("TAG+=\"uaccess\""));
  CHECK(rule.find("MODE=\"0666\"") == std::string::npos);
  const TempFolder folder;
  CHECK(install("--root '" + folder.path().string() + "'").status == 0);
  CHECK(text_of(folder.path() / "etc/udev/rules.d" / kName) == rule);
}

TEST_CASE("the installer of udev rules refuses arguments that it does not know") {
  CHECK(install("--rot /tmp").status != 0);
  CHECK(install("--root").status != 0);
  CHECK(install("''").status != 0);
}

}  // namespace
}  // namespace touchtrial

// The program servo_jitter as its users run it: its output is complete and consistent. The lateness
// of ticks depends on the machine and is not tested.
#include "app/touchtrial_process.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <filesystem>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

const std::filesystem::path kProgram = TOUCHTRIAL_SERVO_JITTER;

TEST_CASE("servo_jitter measures every combination of rate, policy and load that it is given") {
  const TempFolder folder;
  const ProgramResult result = run_program(
      kProgram, folder.path(),
      {"--rate", "1000,4000", "--policy", "other", "--load", "0,1", "--seconds", "0.3", "--json"});
  REQUIRE(result.exit_code == 0);
  const auto json = nlohmann::json::parse(result.output);
  CHECK(json["measured"] == "lateness");
  REQUIRE(json["measurements"].size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& one = json["measurements"][i];
    CHECK(one["rate_hz"] == (i < 2 ? 1000.0 : 4000.0));
    CHECK(one["load"] == i % 2);
    CHECK(one["obtained"]["policy"] == "other");
    const auto due = static_cast<std::int64_t>(one["rate_hz"].get<double>() * 0.3);
    CHECK(one["ticks"].get<std::int64_t>() + one["overruns"].get<std::int64_t>() <= due);
    CHECK(one["ticks"].get<std::int64_t>() >= 1);
    CHECK(one["p50_us"] <= one["p99_us"]);
    CHECK(one["p99_us"] <= one["worst_us"]);
  }
}

TEST_CASE("all unpaced ticks reach the writer, and none is dropped") {
  const TempFolder folder;
  const ProgramResult result =
      run_program(kProgram, folder.path(), {"--unpaced", "200000", "--policy", "other", "--json"});
  REQUIRE(result.exit_code == 0);
  const auto one = nlohmann::json::parse(result.output)["measurements"].at(0);
  CHECK(one["ticks"].get<std::int64_t>() + one["overruns"].get<std::int64_t>() == 200'000);
  CHECK(one["dropped"] == 0);
  CHECK(one["written_samples"] == one["ticks"]);
  CHECK(one["p50_us"] > 0.0);
}

TEST_CASE("servo_jitter draws its histograms") {
  const TempFolder folder;
  const auto picture = folder.path() / "jitter.svg";
  const ProgramResult result =
      run_program(kProgram, folder.path(),
                  {"--policy", "other", "--seconds", "0.05", "--picture", picture.string()});
  REQUIRE(result.exit_code == 0);
  CHECK(result.output.find("| 1000 | other | other") != std::string::npos);
  CHECK(std::filesystem::file_size(picture) > 1000);
}

TEST_CASE("servo_jitter refuses invalid arguments in one line") {
  const TempFolder folder;
  const auto arguments = GENERATE(std::vector<std::string>{"--rate", "999"},
                                  std::vector<std::string>{"--policy", "idle"},
                                  std::vector<std::string>{"--picture", "jitter.jpg"},
                                  std::vector<std::string>{"--unpaced", "5", "--seconds", "1"});
  const ProgramResult result = run_program(kProgram, folder.path(), arguments);
  CHECK(result.exit_code == 2);
  CHECK(result.output.empty());
  CHECK(line_count(result.errors) == 1);
}

}  // namespace
}  // namespace touchtrial

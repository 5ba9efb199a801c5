#include "app/touchtrial_process.hpp"
#include "core/files.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <string>

#include <nlohmann/json.hpp>

using namespace touchtrial;
using nlohmann::json;

TEST_CASE("device compensation shows what shaping a force delivers and costs on a model") {
  const TempFolder folder;
  const ProgramResult table =
      run_touchtrial(folder.path(), {"device", "compensation", "touch", "--most-gain-db", "6"});
  INFO(table.errors);
  REQUIRE(table.exit_code == 0);
  CHECK_THAT(table.output, holds_text("SIMULATED") && holds_text("stylus_grip") &&
                               holds_text("stiffest wall") && holds_text("measured on a device"));
  const ProgramResult result =
      run_touchtrial(folder.path(), {"device", "compensation", "falcon", "--hand", "point_mass",
                                     "--most-gain-db", "12", "--json"});
  REQUIRE(result.exit_code == 0);
  const json figures = json::parse(result.output);
  CHECK(figures.at("model") == "falcon");
  CHECK(figures.at("hand") == "point_mass");
  CHECK(figures.at("simulated") == true);
  CHECK(figures.at("responses").size() == 16);
  for (const json& at : figures.at("responses")) {
    CHECK(at.at("with_m_s2_per_n").get<double>() > at.at("without_m_s2_per_n").get<double>());
    CHECK(at.at("gain_db").get<double>() < 12.4);
  }
  CHECK(figures.at("with").at("noise_motors_n").get<double>() >
        figures.at("without").at("noise_motors_n").get<double>());
}

TEST_CASE("device compensation names every key of its JSON in the data dictionary") {
  const TempFolder folder;
  const ProgramResult result =
      run_touchtrial(folder.path(), {"device", "compensation", "ideal", "--json"});
  REQUIRE(result.exit_code == 0);
  const std::string page = text_of(
      read_file(std::filesystem::path(TOUCHTRIAL_SOURCE_DIR) / "docs" / "data-dictionary.md"));
  const std::string section = page.substr(page.find("## Compensation"));
  const json figures = json::parse(result.output);
  const auto require_keys = [&](const json& object) {
    for (const auto& item : object.items()) {
      INFO(item.key());
      CHECK(section.find(item.key() + "`") != std::string::npos);
    }
  };
  require_keys(figures);
  require_keys(figures.at("responses").at(0));
  require_keys(figures.at("with"));
}

TEST_CASE("device compensation refuses models, hands and bounds that it does not know") {
  const TempFolder folder;
  const auto refusal = [&](const std::vector<std::string>& more) {
    std::vector<std::string> command = {"device", "compensation"};
    command.insert(command.end(), more.begin(), more.end());
    const ProgramResult result = run_touchtrial(folder.path(), command);
    CHECK(result.exit_code == 2);
    return result.errors;
  };
  CHECK_THAT(refusal({"toch"}), holds_text("did you mean touch?"));
  CHECK_THAT(refusal({"touch", "--hand", "fist"}), holds_text("--hand"));
  CHECK_THAT(refusal({"touch", "--most-gain-db", "41"}), holds_text("--most-gain-db"));
  CHECK_THAT(refusal({"touch", "--most-gain-db", "nan"}), holds_text("--most-gain-db"));
  CHECK_THAT(refusal({}), holds_text("MODEL"));
}

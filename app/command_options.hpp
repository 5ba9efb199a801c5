/// \file Arguments and options that several commands share. Private to app: it shows the parser's
/// type.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>

namespace touchtrial::app {

/// \name Files
/// Every variable must live as long as the command.
///@{

/// STUDY, required.
void add_study_argument(CLI::App& command, std::filesystem::path& study);
/// DB, required: a database file.
CLI::Option* add_database_argument(CLI::App& command, std::filesystem::path& database,
                                   const std::string& meaning = "Database of the study");
/// DB, required: a database file, or an address such as postgresql://HOST/NAME. Refuses passwords,
/// which libpq's own notation may contain.
void add_study_place_argument(CLI::App& command, std::filesystem::path& place);
/// --key; see key_of_database.
CLI::Option* add_key_option(CLI::App& command, std::filesystem::path& key);
/// --pack; see pack_place_for.
void add_pack_option(CLI::App& command, std::filesystem::path& pack);
/// --subject; see subject_for.
void add_subject_option(CLI::App& command, std::filesystem::path& subject);
/// Refuses addresses where a file or folder of this machine is needed. The message does not repeat
/// the address, which may contain a password.
[[nodiscard]] CLI::Validator place_validator();

///@}
/// \name Devices
///@{

/// A driver's name, required.
/// \param name  of the argument or option
void add_driver_argument(CLI::App& command, const std::string& name, std::string& driver);
/// --settings; see device::device_settings_for.
void add_settings_option(CLI::App& command, std::filesystem::path& settings);
/// --rate, 1,000 to 10,000 Hz.
void add_rate_option(CLI::App& command, double& rate_hz);

///@}
/// \name Work and output
///@{

/// --seed: a whole number from 0 to 2^64 - 1. The parser itself would accept -1 for 2^64 - 1.
void add_seed_option(CLI::App& command, std::uint64_t& seed, const std::string& meaning);
/// --jobs, by default as many as there are logical cores.
void add_jobs_option(CLI::App& command, int& jobs);
/// --json
CLI::Option* add_json_flag(CLI::App& command, bool& json);

///@}

}  // namespace touchtrial::app

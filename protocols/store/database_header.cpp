#include "protocols/store/database_header.hpp"

#include "core/errors.hpp"
#include "protocols/store/damaged_store.hpp"
#include "protocols/store/tables.hpp"

#include <array>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

namespace touchtrial::store {
namespace {

constexpr char kSqliteMagic[] = "SQLite format 3";  // its final zero is part of it
using Header = std::array<unsigned char, 100>;

[[noreturn]] void refuse_file(const std::filesystem::path& path, const std::string& why) {
  throw StoreError(one_line(path.string()) + ": " + why);
}

[[noreturn]] void refuse_damaged(const std::filesystem::path& path, const std::string& why) {
  throw DamagedStore(one_line(path.string()) + ": " + why + "; restore it from a backup");
}

Header read_header(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) {
    refuse_file(path, "no such database; check the name, or make one with `touchtrial simulate`");
  }
  if (std::filesystem::is_directory(status))
    refuse_file(path, "is a folder; name a database in it");
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse_file(path, "cannot be read; check its permissions");
  Header header{};
  file.read(reinterpret_cast<char*>(header.data()), header.size());
  const bool whole = file.gcount() == static_cast<std::streamsize>(header.size());
  if (!whole || std::memcmp(header.data(), kSqliteMagic, sizeof kSqliteMagic) != 0) {
    refuse_file(path, "is no Touchtrial database; check the name");
  }
  return header;
}

std::uint32_t big_endian_32(const Header& header, std::size_t offset) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) number = (number << 8U) | header[offset + i];
  return number;
}

std::uintmax_t size_in_header(const Header& header) {
  const unsigned stored = (unsigned{header[16]} << 8U) | header[17];
  const std::uintmax_t page_size = stored == 1 ? 65536 : stored;
  return page_size * big_endian_32(header, 28);
}

}  // namespace

bool has_log(const std::filesystem::path& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path.string() + "-wal", error);
  return !error && size > 0;
}

void check_header(const std::filesystem::path& path, int newest_version) {
  const Header header = read_header(path);
  if (big_endian_32(header, 68) != static_cast<std::uint32_t>(kApplicationId)) {
    refuse_file(path, "is an SQLite database, but none of Touchtrial; check the name");
  }
  const std::uint32_t version = big_endian_32(header, 60);
  if (version > static_cast<std::uint32_t>(newest_version)) {
    refuse_file(path, "was written by a newer Touchtrial (schema " + std::to_string(version) +
                          ", this one knows " + std::to_string(newest_version) +
                          "); use that version");
  }
  if (version == 0) refuse_damaged(path, "has no schema version, so it is damaged");
  if (version < std::uint32_t{kOldestSchemaVersion}) {
    refuse_file(path, "was written by an older Touchtrial (schema " + std::to_string(version) +
                          ", the oldest that this one knows is " +
                          std::to_string(kOldestSchemaVersion) +
                          "); use the program that wrote it");
  }
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  // A log may hold pages that the file still lacks.
  if (!error && size < size_in_header(header) && !has_log(path)) {
    refuse_damaged(path, "is truncated");
  }
}

}  // namespace touchtrial::store

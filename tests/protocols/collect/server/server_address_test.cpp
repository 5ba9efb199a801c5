#include "protocols/collect/server_address.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>

using namespace touchtrial;
using namespace touchtrial::collect;

namespace {

std::string refusal_of(const std::string& where) {
  try {
    const ServerAddress address(where);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

/// A variable of the environment as long as it lives.
struct Variable {
  Variable(const char* name, const std::string& value) : name_(name) {
    ::setenv(name, value.c_str(), 1);
  }
  ~Variable() { ::unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
};

bool verifies(const std::string& where) {
  const ServerAddress address(where);
  const std::string& text = address.connection_string();
  const bool verifies = text.find("sslmode='verify-full'") != std::string::npos &&
                        text.find("gssencmode='disable'") != std::string::npos;
  CHECK(verifies == !address.is_local());
  return verifies;
}

}  // namespace

TEST_CASE("every connection to another machine is verified, and local ones are left alone") {
  for (const char* const local :
       {"postgresql:///study", "postgresql://localhost/study", "postgresql://127.0.0.1/study",
        "postgresql://127.9.8.7:5433/study", "postgresql://[::1]/study",
        "postgresql:///study?host=/run/x", "postgresql://lab.example/study?hostaddr=127.0.0.1",
        "postgresql://localhost,127.0.0.1/study", "postgresql://localhost/study?sslmode=disable"}) {
    INFO(local);
    CHECK_FALSE(verifies(local));
  }
  for (const char* const remote :
       {"postgresql://lab.example/study", "postgresql://10.0.0.7/study",
        "postgresql://[2001:db8::1]/study", "postgresql://127.0.0.1.lab.example/study",
        "postgresql://localhost.lab.example/study", "postgresql://127.1/study",
        "postgresql://localhost/study?hostaddr=10.0.0.7", "postgresql://localhost,lab/study",
        "postgresql:///study?hostaddr=10.0.0.7", "postgresql://lab/study?sslmode=verify-full",
        "postgresql://%6cab/study", "postgresql://[::ffff:10.0.0.7]/study"}) {
    INFO(remote);
    CHECK(verifies(remote));
  }
}

TEST_CASE("less than verify-full to another machine is refused with the remedy") {
  for (const char* const mode :
       {"sslmode=disable", "sslmode=allow", "sslmode=prefer", "sslmode=require",
        "sslmode=verify-ca", "sslmode=", "ssl=true", "sslmode=VERIFY-FULL"}) {
    INFO(mode);
    const std::string line = refusal_of(std::string("postgresql://lab/study?") + mode);
    CHECK_THAT(line, holds_text("?sslmode=verify-full"));
    CHECK_THAT(line, holds_text("sslrootcert=FILE"));
  }
  CHECK_THAT(refusal_of("postgresql://lab/study?gssencmode=prefer"), holds_text("gssencmode"));
}

TEST_CASE("neither environment nor service file leads to another machine unverified") {
  const TempFolder folder;
  const auto services = folder.path() / "services";
  replace_file(services, "[lab]\nhost=lab.example\nsslmode=disable\n\n[here]\nhost=/run/x\n",
               FileMode::owner_only);
  {
    const Variable mode("PGSSLMODE", "disable");
    const Variable old("PGREQUIRESSL", "0");
    const Variable gss("PGGSSENCMODE", "prefer");
    CHECK(verifies("postgresql://lab/study"));
  }
  {
    const Variable host("PGHOST", "lab");
    CHECK(verifies("postgresql:///study"));
    CHECK_FALSE(verifies("postgresql://localhost/study"));
  }
  {
    const Variable number("PGHOSTADDR", "10.0.0.7");
    CHECK(verifies("postgresql:///study"));
    CHECK(verifies("postgresql://localhost/study"));
  }
  const Variable file("PGSERVICEFILE", services.string());
  CHECK(verifies("postgresql://?service=lab"));
  CHECK_FALSE(verifies("postgresql://?service=here"));
  {
    const Variable service("PGSERVICE", "lab");
    CHECK(verifies("postgresql:///study"));
    CHECK_FALSE(verifies("postgresql://?service=here"));
    CHECK(std::string(std::getenv("PGSERVICE")) == "lab");
  }
  CHECK(std::getenv("PGSERVICE") == nullptr);
}

TEST_CASE("a connection is waited for a bounded time, whatever address and environment say") {
  const auto waits = [](const std::string& where) {
    const std::string text = ServerAddress(where).connection_string();
    const std::string name = "connect_timeout='";
    const std::size_t begin = text.find(name) + name.size();
    return text.substr(begin, text.find('\'', begin) - begin);
  };
  CHECK(waits("postgresql:///study?connect_timeout=3") == "3");
  CHECK(waits("postgresql:///study?connect_timeout=0") == "10");
  CHECK(waits("postgresql:///study?connect_timeout=-1") == "10");
  CHECK(waits("postgresql:///study?connect_timeout=9999") == "60");
  const Variable timeout("PGCONNECT_TIMEOUT", "0");
  CHECK(waits("postgresql:///study") == "10");
  CHECK(waits("postgresql:///study?connect_timeout=3") == "3");
}

TEST_CASE("files with passwords that others may read are refused") {
  const TempFolder folder;
  const auto refusal = [](const std::string& where) -> std::string {
    try {
      const ServerAddress address(where);
    } catch (const FileError& error) {
      return error.what();
    }
    return "";
  };
  const auto passwords = folder.path() / "passwords";
  replace_file(passwords, "lab:5432:study:anna:geheim\n");
  {
    const Variable file("PGPASSFILE", passwords.string());
    CHECK_THAT(refusal("postgresql://lab/study"), holds_text("chmod 600"));
  }
  CHECK_THAT(refusal("postgresql://lab/study?passfile=" + passwords.string()),
             holds_text("chmod 600"));
  const auto services = folder.path() / "services";
  const Variable file("PGSERVICEFILE", services.string());
  replace_file(services, "[lab]\nhost=lab\n");
  CHECK(refusal("postgresql://?service=lab").empty());
  replace_file(services, "[lab]\nhost=lab\npassword=geheim\n");
  const std::string line = refusal("postgresql://?service=lab");
  CHECK_THAT(line, holds_text("chmod 600"));
  CHECK(line.find("geheim") == std::string::npos);
  std::filesystem::permissions(services, std::filesystem::perms(0600));
  CHECK(refusal("postgresql://?service=lab").empty());
}

TEST_CASE("everything with a scheme is an address and no file") {
  CHECK(is_address("postgresql://host/study"));
  CHECK(is_address("postgressql://host/study"));
  CHECK_FALSE(is_address("study.db"));
  CHECK_FALSE(is_address("/data/postgresql/study.db"));
}

TEST_CASE("an address is shown without its user") {
  CHECK(ServerAddress("postgresql://anna@lab.example:5433/study").shown() ==
        "postgresql://lab.example:5433/study");
  CHECK(ServerAddress("postgresql:///study?host=/run/x&user=anna").shown() ==
        "postgresql:///study?host=/run/x");
  CHECK(ServerAddress("postgresql://?service=lab").shown() == "postgresql:///?service=lab");
}

TEST_CASE("an address is passed on whole, and waits a bounded time") {
  const std::string text =
      ServerAddress("postgresql://anna@lab.example/st%27u%5Cdy?options=-csearch_path%3Dpilot")
          .connection_string();
  CHECK_THAT(text, holds_text("user='anna'"));
  CHECK_THAT(text, holds_text("host='lab.example'"));
  CHECK_THAT(text, holds_text("dbname='st\\'u\\\\dy'"));
  CHECK_THAT(text, holds_text("options='-csearch_path=pilot'"));
  CHECK_THAT(text, holds_text("connect_timeout='10'"));
  CHECK_THAT(ServerAddress("postgresql://lab/study?connect_timeout=3").connection_string(),
             holds_text("connect_timeout='3'"));
}

TEST_CASE("an address with a password is refused, and not repeated") {
  for (const char* const where :
       {"postgresql://anna:geheim@lab/study", "postgresql://lab/study?password=geheim",
        "postgresql://lab/study?sslpassword=geheim", "postgres://anna:geheim@lab/study"}) {
    const std::string line = refusal_of(where);
    INFO(where);
    CHECK_THAT(line, holds_text(".pgpass"));
    CHECK(line.find("geheim") == std::string::npos);
  }
}

TEST_CASE("a text that is no address is refused, and not repeated") {
  for (const char* const where : {"postgressql://anna:geheim@lab/study", "mysql://geheim@lab",
                                  "host=lab password=geheim", "postgresql://anna:geheim@[lab/study",
                                  "postgresql://lab/study?passwort=geheim", "study.db", ""}) {
    const std::string line = refusal_of(where);
    INFO(where);
    CHECK_THAT(line, holds_text("postgresql://USER@HOST/DATABASE"));
    CHECK(line.find("geheim") == std::string::npos);
  }
}

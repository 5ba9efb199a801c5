#include "core/errors.hpp"
#include "record/merging/postgres/server_connection.hpp"
#include "support/catch.hpp"
#include "support/environment.hpp"
#include "support/refusal.hpp"

#include <cstdlib>

using namespace touchtrial;
using namespace touchtrial::merging;

namespace {

std::string refusal_of(const std::string& where) {
  return message_of<UsageError>([&] { return connection_options(where); });
}

bool verifies(const std::string& where) {
  ConnectionOptions options = connection_options(where);
  return options["sslmode"] == "verify-full" && options["gssencmode"] == "disable";
}

}  // namespace

TEST_CASE("every connection to another machine is verified, and local ones are left alone") {
  for (const char* const local :
       {"postgresql:///study", "postgresql://localhost/study", "postgresql://127.0.0.1/study",
        "postgresql://[::1]/study", "postgresql:///study?host=/run/x",
        "postgresql://lab.example/study?hostaddr=127.0.0.1",
        "postgresql://localhost/study?sslmode=disable"}) {
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

TEST_CASE("neither environment nor service file says where the server is") {
  {
    const EnvironmentVariable mode("PGSSLMODE", "disable");
    const EnvironmentVariable gss("PGGSSENCMODE", "prefer");
    CHECK(verifies("postgresql://lab/study"));
  }
  const EnvironmentVariable host("PGHOST", "lab");
  const EnvironmentVariable number("PGHOSTADDR", "10.0.0.7");
  const EnvironmentVariable service("PGSERVICE", "lab");
  CHECK_FALSE(verifies("postgresql:///study"));
  for (const char* const name : {"PGHOST", "PGHOSTADDR", "PGSERVICE"}) {
    CHECK(std::getenv(name) == nullptr);
  }
  CHECK_FALSE(refusal_of("postgresql://?service=lab").empty());
}

TEST_CASE("a connection is waited for a bounded time, whatever address and environment say") {
  const EnvironmentVariable unbounded("PGCONNECT_TIMEOUT", "0");
  const auto waits = [](const std::string& where) {
    return connection_options(where)["connect_timeout"];
  };
  CHECK(waits("postgresql:///study") == "10");
  CHECK(waits("postgresql:///study?connect_timeout=3") == "3");
  CHECK(waits("postgresql:///study?connect_timeout=0") == "10");
  CHECK(waits("postgresql:///study?connect_timeout=-1") == "10");
  CHECK(waits("postgresql:///study?connect_timeout=9999") == "60");
}

TEST_CASE("an address is passed on whole") {
  const ConnectionOptions options =
      connection_options("postgresql://anna@lab.example/st%27u%5Cdy?options=-csearch_path%3Dpilot");
  CHECK(options.at("user") == "anna");
  CHECK(options.at("host") == "lab.example");
  CHECK(options.at("dbname") == "st'u\\dy");
  CHECK(options.at("options") == "-csearch_path=pilot");
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

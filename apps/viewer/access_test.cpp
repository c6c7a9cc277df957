#include "access.h"

#include <gtest/gtest.h>

namespace marey::viewer {
namespace {

const std::string kToken = "0123456789abcdef0123456789abcdef0123456789abcdef";

Access some_access() {
  return {kToken, "marey_8780", {"studio", "studio.local"}};
}

net::HttpRequest own_page() {
  return {.method = "GET",
          .target = "/scene",
          .host = "127.0.0.1:8780",
          .origin = "http://127.0.0.1:8780",
          .cookie = "other=1; marey_8780=" + kToken,
          .authorization = {},
          .upgrade = false};
}

TEST(Access, OurOwnPageMayLook) {
  EXPECT_EQ(some_access().check(own_page()).status, 200);
  EXPECT_FALSE(some_access().check(own_page()).by_link);
  net::HttpRequest socket = own_page();
  socket.upgrade = true;
  EXPECT_EQ(some_access().check(socket).status, 200);
}

TEST(Access, TheAddressThatIsPrintedSetsTheCookie) {
  net::HttpRequest head = own_page();
  head.origin.clear();
  head.cookie.clear();
  head.target = "/?a=b&token=" + kToken;
  EXPECT_EQ(some_access().check(head).status, 200);
  EXPECT_TRUE(some_access().check(head).by_link);
  EXPECT_EQ(some_access().set_cookie(), "marey_8780=" + kToken + "; Path=/; HttpOnly; SameSite=Strict");
}

TEST(Access, WithoutTheTokenNobodyMay) {
  for (const std::string& cookie : {std::string(), std::string("marey_8780="), "marey_8780=" + kToken.substr(1),
                                    "marey_8781=" + kToken, "xmarey_8780=" + kToken, "marey_8780=" + kToken + "0"}) {
    net::HttpRequest head = own_page();
    head.cookie = cookie;
    EXPECT_EQ(some_access().check(head).status, 401) << cookie;
  }
  for (const std::string& target :
       {std::string("/?token="), std::string("/?token"), "/?token=" + kToken.substr(2), "/" + kToken, "/?x=" + kToken}) {
    net::HttpRequest head = own_page();
    head.cookie.clear();
    head.target = target;
    EXPECT_EQ(some_access().check(head).status, 401) << target;
  }
}

TEST(Access, NamesOfOtherMachinesAreRefusedForTheyMayBeBoundAnew) {
  for (const char* host : {"127.0.0.1", "127.0.0.1:9", "localhost", "localhost:8780", "[::1]:8780", "192.168.0.7:8780",
                           "studio:8780", "studio.local"}) {
    net::HttpRequest head = own_page();
    head.host = host;
    head.origin = std::string("http://") + host;
    EXPECT_EQ(some_access().check(head).status, 200) << host;
  }
  for (const char* host : {"", "evil.example", "evil.example:8780", "127.0.0.1.evil.example", "localhost.evil.example",
                           "1.2.3:8780", "[::1", "[evil]:1", "127.0.0.1:8780@evil", "studio.evil"}) {
    net::HttpRequest head = own_page();
    head.host = host;
    head.origin = std::string("http://") + host;
    EXPECT_EQ(some_access().check(head).status, 403) << host;
  }
}

TEST(Access, PagesOfOtherSitesAreRefusedThoughTheBrowserBringsTheCookie) {
  for (const char* origin :
       {"http://evil.example", "null", "https://127.0.0.1:8780", "http://127.0.0.1:8781", "http://127.0.0.1"}) {
    net::HttpRequest head = own_page();
    head.origin = origin;
    for (const bool upgrade : {false, true}) {
      head.upgrade = upgrade;
      EXPECT_EQ(some_access().check(head).status, 403) << origin;
    }
  }
}

TEST(Access, AProgramBringsAnAuthorization) {
  net::HttpRequest head = own_page();
  head.origin.clear();
  head.upgrade = true;
  EXPECT_EQ(some_access().check(head).status, 403);  // neither a page nor a program that says who it is
  head.cookie.clear();
  head.authorization = "token " + kToken;
  EXPECT_EQ(some_access().check(head).status, 200);
  head.authorization = "token ";
  EXPECT_EQ(some_access().check(head).status, 401);
}

}  // namespace
}  // namespace marey::viewer

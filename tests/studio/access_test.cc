#include "pipeline/studio/access/access.h"

#include <gtest/gtest.h>

#include "pipeline/studio/access/token.h"

namespace glint {
namespace {

const Door kDoor{{"127.0.0.1", "localhost"}, 8417, "secret", true};

HttpRequest Request(const std::string& method, const std::string& host,
                    const std::string& origin = "", bool own_header = true) {
  HttpRequest request;
  request.method = method;
  request.headers["host"] = host;
  if (!origin.empty()) request.headers["origin"] = origin;
  if (own_header) request.headers["x-glint"] = "1";
  return request;
}

int StatusOf(const HttpRequest& request) {
  try {
    CheckHostAndOrigin(kDoor, request);
    return 200;
  } catch (const HttpError& error) {
    return error.status;
  }
}

TEST(Access, OnlyServedAddressesAreAnswered) {
  EXPECT_EQ(StatusOf(Request("GET", "127.0.0.1:8417")), 200);
  EXPECT_EQ(StatusOf(Request("GET", "localhost:8417")), 200);
  for (const char* host : {"", "evil.example:8417", "127.0.0.1", "127.0.0.1:80", "127.0.0.1:84170",
                           "127.0.0.1.evil.example:8417", "[::1]:8417"}) {
    EXPECT_EQ(StatusOf(Request("GET", host)), 421) << host;
  }
}

TEST(Access, WritesNeedTheirOwnOriginAndHeader) {
  const std::string host = "127.0.0.1:8417", own = "http://127.0.0.1:8417";
  EXPECT_EQ(StatusOf(Request("POST", host, own)), 200);
  EXPECT_EQ(StatusOf(Request("POST", host)), 403);
  EXPECT_EQ(StatusOf(Request("POST", host, "null")), 403);
  EXPECT_EQ(StatusOf(Request("POST", host, "http://evil.example")), 403);
  EXPECT_EQ(StatusOf(Request("POST", host, "http://127.0.0.1:9")), 403);
  EXPECT_EQ(StatusOf(Request("POST", host, "https://127.0.0.1:8417")), 403);
  EXPECT_EQ(StatusOf(Request("POST", host, own, false)), 403);
  EXPECT_EQ(StatusOf(Request("DELETE", host, own, false)), 403);
  EXPECT_EQ(StatusOf(Request("GET", host, "http://evil.example")), 403);
}

TEST(Access, TheSessionsCookieIsNeededAndCannotBeGuessedByItsLength) {
  HttpRequest request;
  EXPECT_THROW(CheckSession(kDoor, request), HttpError);
  for (const char* cookie : {"glint_studio_8417=", "glint_studio_8417=secre",
                             "glint_studio_8417=secrets", "glint_studio_8418=secret", "secret"}) {
    request.headers["cookie"] = cookie;
    EXPECT_THROW(CheckSession(kDoor, request), HttpError) << cookie;
  }
  request.headers["cookie"] = "other=1; glint_studio_8417=secret";
  EXPECT_NO_THROW(CheckSession(kDoor, request));
}

TEST(Access, ADoorWithoutSessionLetsNoBrowserIn) {
  const Door door{{"10.0.0.1"}, 1, "", false};
  HttpRequest request;
  request.headers["cookie"] = "glint_studio_1=";
  request.query["t"] = "";
  EXPECT_THROW(CheckSession(door, request), HttpError);
  EXPECT_FALSE(OpenSession(door, request));
}

TEST(Access, TheOpenedAddressSetsACookieThatScriptsCannotRead) {
  HttpRequest request;
  request.query["t"] = "secret";
  const auto reply = OpenSession(kDoor, request);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 303);
  std::string cookie;
  for (const auto& [name, value] : reply->headers) {
    if (name == "Set-Cookie") cookie = value;
  }
  EXPECT_NE(cookie.find("HttpOnly"), std::string::npos);
  EXPECT_NE(cookie.find("SameSite=Strict"), std::string::npos);
}

TEST(Token, TokensDiffer) {
  EXPECT_EQ(RandomToken().size(), 32u);
  EXPECT_NE(RandomToken(), RandomToken());
  EXPECT_FALSE(SameSecret("", ""));
}

TEST(HttpTypes, PathsAreCutAtSlashesAndEmptyPartsStay) {
  HttpRequest request;
  request.path = "/api//x";
  EXPECT_EQ(request.Segments(), (std::vector<std::string>{"api", "", "x"}));
  request.path = "/";
  EXPECT_EQ(request.Segments(), (std::vector<std::string>{""}));
}

}  // namespace
}  // namespace glint

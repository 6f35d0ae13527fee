#include "flute_grinder/network/ros_api.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <ros/init.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>

// Calls of a master that answers, hangs, closes, or sends something else.
namespace grinder {
namespace test_ros_api {

using XmlRpc::XmlRpcValue;

/// Listens on a port of its own, and treats each connection as a test wants. Ends with this object.
class Server {
 public:
  using Treat = std::function<void(int connection)>;

  explicit Server(Treat treat) : listener_(::socket(AF_INET, SOCK_STREAM, 0)) {
    address_.sin_family = AF_INET;
    address_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address_;
    auto* address = reinterpret_cast<sockaddr*>(&address_);
    if (::bind(listener_, address, size) != 0 || ::listen(listener_, 1) != 0 ||
        ::getsockname(listener_, address, &size) != 0) {
      throw std::runtime_error("no port");
    }
    thread_ = std::thread([this, treat = std::move(treat)] {
      for (int connection = 0; (connection = ::accept(listener_, nullptr, nullptr)) >= 0; ::close(connection)) {
        treat(connection);
      }
    });
  }
  ~Server() {
    ::shutdown(listener_, SHUT_RDWR);
    thread_.join();
    ::close(listener_);
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  unsigned port() const { return ntohs(address_.sin_port); }

 private:
  int listener_;
  sockaddr_in address_{};
  std::thread thread_;
};

/// The request, up to its end or that of the connection.
std::string read(int connection) {
  std::string text;
  std::array<char, 4096> part{};
  while (text.find("</methodCall>") == std::string::npos) {
    const ssize_t count = ::recv(connection, part.data(), part.size(), 0);
    if (count <= 0) break;
    text.append(part.data(), static_cast<std::size_t>(count));
  }
  return text;
}

void send(int connection, const std::string& text) {
  static_cast<void>(::send(connection, text.data(), text.size(), MSG_NOSIGNAL));
}

/// @param values of the array that a ROS API answers with.
std::string answer(const std::string& values) {
  const std::string body = "<?xml version=\"1.0\"?>\r\n<methodResponse><params><param><value><array><data>" + values +
                           "</data></array></value></param></params></methodResponse>\r\n";
  return "HTTP/1.1 200 OK\r\nServer: test\r\nContent-Type: text/xml\r\nContent-length: " + std::to_string(body.size()) +
         "\r\n\r\n" + body;
}

std::string integer(int value) { return "<value><i4>" + std::to_string(value) + "</i4></value>"; }
const std::string kText = "<value>text</value>";

std::optional<XmlRpcValue> call(const Server& server, const std::atomic<bool>& stop = false) {
  return callRosApi("127.0.0.1", server.port(), "getPid", {XmlRpcValue("first"), XmlRpcValue(2)}, stop);
}

TEST(RosApi, GivesTheValueOfTheAnswer) {
  std::string request;
  {
    const Server server([&](int connection) {
      request = read(connection);
      send(connection, answer(integer(1) + kText + integer(42)));
    });
    std::optional<XmlRpcValue> value = call(server);
    ASSERT_TRUE(value);
    EXPECT_EQ(static_cast<int>(*value), 42);
  }
  EXPECT_NE(request.find("<methodName>getPid</methodName>"), std::string::npos);
  EXPECT_LT(request.find("first"), request.find("<i4>2</i4>"));
}

TEST(RosApi, GivesNothingForAnErrorOrAnythingElse) {
  for (const std::string& wrong :
       {answer(integer(0) + kText + integer(42)), answer(integer(-1) + kText + integer(42)), answer(integer(1) + kText),
        answer(""), answer(kText + kText + integer(42)), answer(integer(1) + kText + integer(42) + integer(43)),
        std::string("HTTP/1.1 404 Not Found\r\n\r\n"), std::string("garbage"), std::string("\0\xff\0\xff\r\n\r\n", 8),
        std::string()}) {
    const Server server([&](int connection) {
      read(connection);
      send(connection, wrong);
    });
    EXPECT_FALSE(call(server)) << wrong;
  }
}

TEST(RosApi, GivesNothingIfTheConnectionClosesAtOnce) {
  const Server server([](int) {});
  EXPECT_FALSE(call(server));
}

TEST(RosApi, GivesNothingIfNobodyListens) {
  unsigned port = 0;
  {
    const Server server([](int) {});
    port = server.port();
  }
  const std::atomic<bool> never{false};
  EXPECT_FALSE(callRosApi("127.0.0.1", port, "getPid", {}, never));
}

TEST(RosApi, GivesUpAServerThatHangs) {
  const Server server([](int connection) {
    read(connection);
    read(connection);  // to the client's end
  });
  EXPECT_FALSE(call(server));
}

TEST(RosApi, GivesNothingOnceItIsStopped) {
  const Server server([](int connection) {
    read(connection);
    send(connection, answer(integer(1) + kText + integer(42)));
  });
  EXPECT_FALSE(call(server, true));
}

TEST(RosApi, TellsAParameterThatIsNotSetFromAMasterThatDoesNotAnswer) {
  const std::atomic<bool> never{false};
  int code = 1;
  {
    const Server master([&](int connection) {
      read(connection);
      send(connection, answer(integer(code) + kText + integer(42)));
    });
    ros::init(ros::M_string{{"__master", "http://127.0.0.1:" + std::to_string(master.port())}}, "test",
              ros::init_options::NoRosout);
    std::optional<XmlRpcValue> value = readParameter("/flange", never);
    ASSERT_TRUE(value);
    EXPECT_EQ(static_cast<int>(*value), 42);
    code = -1;
    EXPECT_FALSE(readParameter("/flange", never));
  }
  EXPECT_THROW(static_cast<void>(readParameter("/flange", never)), std::runtime_error);
}

}  // namespace test_ros_api
}  // namespace grinder

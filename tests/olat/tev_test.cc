#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "olat/tev/images.h"
#include "olat/tev/listener.h"
#include "olat/tev/packet.h"
#include "olat/tev/send.h"
#include "render/files/files.h"

// tev's protocol, with sockets and byte by byte.
namespace likeness::olat_tev {
namespace {

using files::InputError;
using files::UsageError;
using testing::ElementsAre;
using testing::HasSubstr;

template <class... Numbers>
std::string raw(Numbers... numbers) {
  std::string out;
  (out.append(reinterpret_cast<const char*>(&numbers), sizeof numbers), ...);
  return out;
}
std::string text(const std::string& text) { return text + '\0'; }
std::string packet(int type, const std::string& payload) {
  return raw(static_cast<std::uint32_t>(payload.size() + 5)) + static_cast<char>(type) + payload;
}
std::string with_flag(const std::string& name) { return '\1' + text(name); }
std::string rgb_names() { return text("R") + text("G") + text("B"); }

bool eventually(const std::function<bool()>& is_so) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (std::chrono::steady_clock::now() < end) {
    if (is_so()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return false;
}

int connected(int port) {
  const int fd = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const timeval patience{20, 0};
  setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  if (connect(fd, reinterpret_cast<sockaddr*>(&to), sizeof to) == 0) return fd;
  close(fd);
  return -1;
}
void write_all(int fd, const std::string& bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t sent = send(fd, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
    if (sent <= 0) return;
    at += static_cast<std::size_t>(sent);
  }
}
bool is_closed_by_the_other_side(int fd) {
  char byte;
  return recv(fd, &byte, 1, 0) <= 0 && errno != EAGAIN;
}

// As the bytes of tev's own clients are: the layout is tested against numbers written here, not against our writer.
TEST(TevPacket, OfEachVersionIsUnderstood) {
  Images images;
  images.take(packet_of(packet(4, with_flag("a") + raw(2, 2, 3) + rgb_names())));
  images.take(packet_of(packet(3, with_flag("a") + text("R") + raw(0, 0, 2, 1) + raw(1.0f, 2.0f))));
  images.take(packet_of(
      packet(5, with_flag("a") + raw(2) + text("G") + text("B") + raw(0, 1, 2, 1) + raw(3.0f, 4.0f, 5.0f, 6.0f))));
  EXPECT_THAT(images.picture("a")->rgb, ElementsAre(1, 0, 0, 2, 0, 0, 0, 3, 5, 0, 4, 6));
  using Wide = std::int64_t;
  images.take(packet_of(packet(6, with_flag("a") + raw(3) + rgb_names() + raw(0, 0, 2, 2) +
                                      raw(Wide{2}, Wide{1}, Wide{0}) + raw(Wide{3}, Wide{3}, Wide{0}) +
                                      raw(9.f, 1.f, 2.f, 9.f, 3.f, 4.f, 9.f, 5.f, 6.f, 9.f, 7.f, 8.f))));
  EXPECT_THAT(images.picture("a")->rgb, ElementsAre(2, 1, 9, 4, 3, 9, 6, 5, 9, 8, 7, 9));
  images.take(packet_of(packet(2, text("a"))));
  EXPECT_FALSE(images.picture("a"));
  EXPECT_EQ(images.bytes(), 0u);
}

TEST(TevPacket, OfFilesAndLinesChangesNothing) {
  for (const int type : {0, 1, 7, 8})
    EXPECT_TRUE(std::holds_alternative<Ignored>(packet_of(packet(type, with_flag("/etc/passwd") + text("")))));
}

TEST(TevPacket, ThatIsWrongIsRefusedBeforeItCostsMemory) {
  using Wide = std::int64_t;
  constexpr Wide kHuge = std::numeric_limits<Wide>::max();
  const auto update3 = [&](int width, int height, Wide offset, Wide stride, std::size_t values) {
    return packet(6, with_flag("a") + raw(1) + text("R") + raw(0, 0, width, height) + raw(offset) + raw(stride) +
                         std::string(4 * values, '\0'));
  };
  EXPECT_NO_THROW(packet_of(update3(2, 2, 0, 1, 4)));
  EXPECT_NO_THROW(packet_of(update3(2, 2, 3, 0, 4)));
  const std::string create = packet(4, with_flag("a") + raw(2, 2, 3) + rgb_names());
  for (const std::string& wrong : std::vector<std::string>{
           "",
           "abc",
           packet(9, ""),
           packet(255, ""),
           packet(4, "\1abc"),  // no end of a name
           packet(4, with_flag(std::string(5000, 'x')) + raw(2, 2, 1) + text("R")),
           packet(4, with_flag("a") + raw(0, 2, 1) + text("R")),
           packet(4, with_flag("a") + raw(-1, 2, 1) + text("R")),
           packet(4, with_flag("a") + raw(2, 1 << 30, 1) + text("R")),
           packet(4, with_flag("a") + raw(2, 2, 0)),
           packet(4, with_flag("a") + raw(2, 2, 2'000'000'000) + text("R")),
           packet(4, with_flag("a") + raw(2, 2, 3) + text("R")),
           packet(3, with_flag("a") + text("R") + raw(0, 0, 16384, 16384) + raw(1.f)),
           packet(3, with_flag("a") + text("R") + raw(-1, 0, 1, 1) + raw(1.f)),
           packet(5, with_flag("a") + raw(2) + text("R") + text("G") + raw(0, 0, 1, 1) + raw(1.f)),
           update3(2, 2, 1, 1, 4),
           update3(2, 2, -1, 1, 4),
           update3(2, 2, 3, -1, 4),
           update3(2, 2, 0, kHuge, 4),
           update3(2, 2, kHuge, kHuge, 4),
           update3(16384, 16384, 0, 2, 4),
           update3(1, 1, 0, 0, 0),
           create.substr(0, create.size() - 1),
           create + "x",
       })
    EXPECT_THROW(packet_of(wrong), InputError) << wrong.size();
  EXPECT_THROW(length_of(raw(std::uint32_t{4})), InputError);
  EXPECT_THROW(length_of(raw(std::uint32_t{0xffffffff})), InputError);
}

TEST(TevImages, KeepNoMoreThanTheirBytes) {
  Images images(3 * 12 * 100);  // three of 10 x 10
  for (const char* name : {"a", "b", "c"}) images.take(Create{name, 10, 10, {"R", "G", "B"}});
  images.take(Update{"a", {"R"}, 0, 0, 1, 1, {0}, {1}, {1}});
  images.take(Create{"d", 10, 10, {"Y"}});
  std::vector<std::string> names;
  for (const auto& known : images.list()) names.push_back(known.name);
  EXPECT_THAT(names, ElementsAre("a", "c", "d")) << "nobody wrote to b for the longest";
  EXPECT_THROW(images.take(Create{"e", 100, 100, {"R"}}), InputError);
  EXPECT_EQ(images.list().size(), 3u);
  EXPECT_EQ(images.bytes(), 3u * 12 * 100);
  Images many;
  for (std::size_t i = 0; i < 2 * Images::kMostImages; ++i) many.take(Create{std::to_string(i), 1, 1, {"R"}});
  EXPECT_EQ(many.list().size(), Images::kMostImages);
}

TEST(TevImages, AreColorsOfTheFirstLayerOrGrey) {
  Images images;
  images.take(Create{"layers", 1, 1, {"A", "diffuse.R", "diffuse.G", "diffuse.B", "specular.R"}});
  images.take(Update{
      "layers", {"diffuse.R", "specular.R", "A", "diffuse.B"}, 0, 0, 1, 1, {0, 1, 2, 3}, {1, 1, 1, 1}, {1, 2, 3, 4}});
  EXPECT_THAT(images.picture("layers")->rgb, ElementsAre(1, 0, 4));
  images.take(Create{"grey", 1, 1, {"depth.Z"}});
  images.take(Update{"grey", {"depth.Z"}, 0, 0, 1, 1, {0}, {1}, {7}});
  EXPECT_THAT(images.picture("grey")->rgb, ElementsAre(7, 7, 7));
}

TEST(TevImages, AreNotWrittenBeyondTheirBorder) {
  Images images;
  images.take(Create{"a", 2, 2, {"R", "G", "B"}});
  images.take(Update{"a", {"R"}, 1, 1, 2, 1, {0}, {1}, {1, 1}});
  images.take(Update{"a", {"R"}, 16383, 0, 1, 1, {0}, {1}, {1}});
  images.take(Update{"none", {"R"}, 0, 0, 1, 1, {0}, {1}, {1}});
  EXPECT_EQ(images.picture("a")->rgb, std::vector<float>(12, 0.0f));
}

TEST(TevSockets, PassAPictureOnBitForBit) {
  Images images;
  const Listener listener(images, "127.0.0.1:0");
  image::Picture picture(1237, 700);  // of more than one packet, and no whole number of them
  for (std::size_t i = 0; i < picture.rgb.size(); ++i) picture.rgb[i] = static_cast<float>(i) * 0.1f - 7;
  picture.rgb[5] = std::numeric_limits<float>::quiet_NaN();
  {
    Sender sender("127.0.0.1:" + std::to_string(listener.port()));
    sender.send("photo/c0/l0", picture);
    sender.send("second", image::Picture(1, 1));
  }
  ASSERT_TRUE(eventually([&] { return images.version("second").has_value(); }));
  const auto found = images.picture("photo/c0/l0");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->width, 1237);
  EXPECT_EQ(std::memcmp(found->rgb.data(), picture.rgb.data(), picture.rgb.size() * sizeof(float)), 0);
}

TEST(TevSockets, TakePacketsThatArriveByteByByteAndManyAtOnce) {
  Images images;
  const Listener listener(images, "localhost:0");
  const int fd = connected(listener.port());
  for (const char byte : packet(4, with_flag("slow") + raw(2, 2, 3) + rgb_names())) write_all(fd, std::string(1, byte));
  ASSERT_TRUE(eventually([&] { return images.version("slow").has_value(); }));
  std::string many;
  for (int i = 0; i < 200; ++i) many += packet(4, with_flag("many" + std::to_string(i)) + raw(1, 1, 1) + text("R"));
  write_all(fd, many);
  EXPECT_TRUE(eventually([&] { return images.version("many199").has_value(); }));
  close(fd);
}

TEST(TevSockets, AreClosedAfterWhatIsNoPacketAndOthersGoOn) {
  Images images;
  const Listener listener(images, "127.0.0.1:0");
  const int good = connected(listener.port());
  for (const std::string& wrong :
       {std::string("GET / HTTP/1.1\r\n\r\n"), raw(std::uint32_t{0}), raw(std::uint32_t{0x7fffffff}), packet(77, "x"),
        packet(4, with_flag("a") + raw(16384, 16384, 1) + text("R")),
        packet(4, with_flag("a") + raw(2, 1 << 30, 1) + text("R"))}) {
    const int fd = connected(listener.port());
    write_all(fd, wrong);
    EXPECT_TRUE(is_closed_by_the_other_side(fd)) << wrong.size();
    close(fd);
  }
  write_all(good, packet(4, with_flag("b") + raw(1, 1, 1) + text("R")));
  EXPECT_TRUE(eventually([&] { return images.version("b").has_value(); }));
  EXPECT_FALSE(images.version("a"));
  close(good);
}

TEST(TevSockets, MakeRoomForTheNextWhenAllAreSilent) {
  Images images;
  const Listener listener(images, "127.0.0.1:0");
  std::vector<int> silent;
  for (int i = 0; i < 3 * Listener::kConnections; ++i) silent.push_back(connected(listener.port()));
  const int fd = connected(listener.port());
  write_all(fd, packet(4, with_flag("a") + raw(1, 1, 1) + text("R")));
  EXPECT_TRUE(eventually([&] { return images.version("a").has_value(); }));
  EXPECT_TRUE(is_closed_by_the_other_side(silent[0]));
  for (const int other : silent) close(other);
  close(fd);
}

TEST(TevSockets, ListenOnThisMachineOnly) {
  Images images;
  for (const char* address :
       {"0.0.0.0:0", "192.168.1.1:14159", "example.org:1", "127.0.0.1:x", ":5", "127.0.0.1:65536", ""})
    EXPECT_THROW(Listener(images, address), UsageError) << address;
  const Listener listener(images, "127.0.0.1:0");
  EXPECT_THROW(Listener(images, "127.0.0.1:" + std::to_string(listener.port())), UsageError);
}

TEST(TevSockets, SayWhereNobodyListens) {
  int port = 0;
  {
    Images images;
    port = Listener(images, "127.0.0.1:0").port();
  }
  try {
    Sender("127.0.0.1:" + std::to_string(port));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no tev listens there"));
  }
  EXPECT_EQ(host_and_port("render-host").second, 14158);
}

}  // namespace
}  // namespace likeness::olat_tev

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>

#include "fit/measured/measured.h"
#include "render/files/files.h"
#include "tests/fit/measured_files.h"

namespace likeness {
namespace {

using files::InputError;
namespace fs = std::filesystem;

// A folder of its own for each test, gone after it.
struct Folder {
  fs::path path = fs::path(testing::TempDir()) / ("likeness_files_" + std::to_string(::getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
};

// FIPS 180-4 example vectors (NIST "SHA256.pdf"), and the lengths at which the padding takes another block.
TEST(Sha256, MatchesThePublishedVectorsWithAndWithoutInstructions) {
  EXPECT_EQ(files::sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(files::sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(files::sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(files::sha256(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  for (const std::size_t n : {1, 55, 56, 63, 64, 65, 119, 120, 128, 1000})
    EXPECT_EQ(files::sha256(std::string(n, 'x')), files::sha256_portable(std::string(n, 'x'))) << n;
}

TEST(Files, WritesWholeAndLeavesNoTemporary) {
  const Folder folder;
  const fs::path file = folder.path / "new" / "a.txt";
  files::write_whole(file, "one");
  files::write_whole(file, "two");
  EXPECT_EQ(files::read_whole(file, 3), "two");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path / "new"), {}), 1);
  fs::create_directories(folder.path / "taken");
  EXPECT_THROW(files::write_whole(folder.path / "taken", "x"), std::runtime_error);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path), {}), 2) << "no temporary after a failure";
}

TEST(Files, AFullDiskLeavesTheOldFileAndNoTemporary) {
  const Folder folder;
  const fs::path file = folder.path / "a.txt";
  files::write_whole(file, "old");
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{10, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ::setrlimit(RLIMIT_FSIZE, &small);
  EXPECT_THROW(files::write_whole(file, std::string(100, 'x')), std::runtime_error);
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(files::read_whole(file, 100), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path), {}), 1);
}

TEST(Files, ReadsUpToTheLimitAndRefusesBeyond) {
  const Folder folder;
  files::write_whole(folder.path / "a", "12345");
  EXPECT_EQ(files::read_whole(folder.path / "a", 5).size(), 5u);
  EXPECT_THROW(files::read_whole(folder.path / "a", 4), InputError);
  EXPECT_THROW(files::read_whole("/dev/zero", 10000), InputError) << "endless";
}

TEST(Files, SuggestsANameOnlyIfItIsNear) {
  const std::string_view names[]{"callisto", "ggx", "lambert"};
  EXPECT_EQ(files::nearest_name("calisto", names, 3), "callisto");
  EXPECT_EQ(files::nearest_name("gxg", names, 3), "");
  EXPECT_EQ(files::nearest_name("gx", names, 3), "ggx");
}

TEST(Measured, TellsTheFormatFromTheContent) {
  using namespace measured;
  EXPECT_EQ(parse(test::small_mbsdf(), "wrong.csv")->format(), Format::kMbsdf);
  EXPECT_EQ(parse(test::small_rgl(), "wrong.csv")->format(), Format::kRgl);
  EXPECT_EQ(parse(test::small_csv(), "own.txt")->format(), Format::kCsv);
  EXPECT_EQ(parse(test::small_merl({90, 90, 180}), "no_extension")->format(), Format::kMerl);
}

TEST(Measured, RefusesWithOneLineThatNamesTheFile) {
  const Folder folder;
  const auto message = [&](const fs::path& file) {
    try {
      measured::read(file);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const auto with = [&](const char* name, std::string_view bytes) {
    files::write_whole(folder.path / name, bytes);
    return message(folder.path / name);
  };
  EXPECT_THAT(message(folder.path), testing::HasSubstr("is a folder"));
  EXPECT_THAT(message(folder.path / "none.csv"), testing::HasSubstr("No such file"));
  EXPECT_THAT(with("e.csv", ""), testing::HasSubstr("an empty file"));
  EXPECT_THAT(with("m.binary", "short"), testing::HasSubstr("34992012 bytes"));
  EXPECT_THAT(with("m.mbsdf", "no magic"), testing::HasSubstr("NVIDIA ARC MBSDF V1"));
  EXPECT_THAT(with("m.bsdf", "no magic"), testing::HasSubstr("tensor_file"));
  EXPECT_THAT(with("m.png", std::string_view("\x89PNG\r\n\x1a\n\0\0\0", 11)), testing::HasSubstr("unknown kind"));
  for (const char* name : {"e.csv", "m.binary", "m.png"}) {
    EXPECT_THAT(message(folder.path / name), testing::StartsWith((folder.path / name).string()));
    EXPECT_THAT(message(folder.path / name), testing::Not(testing::HasSubstr("\n")));
  }
}

}  // namespace
}  // namespace likeness

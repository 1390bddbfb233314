#include "brdf/eval/block_reader.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <random>

#include "render/files/files.h"

namespace likeness::eval {
namespace {

class BlockReaderTest : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(file); }

  // What the blocks hold together, after a look at each.
  std::string read_back(const std::string& content) {
    files::write_whole(file, content);
    BlockReader reader(file);
    EXPECT_EQ(reader.size(), content.size());
    std::string all;
    Block block;
    for (bool first = true; reader.next(block); first = false) {
      EXPECT_EQ(block.is_first, first);
      EXPECT_EQ(block.first_line, 1 + std::size_t(std::count(all.begin(), all.end(), '\n')));
      EXPECT_TRUE(all.empty() || all.back() == '\n') << "a block begins within a line";
      EXPECT_LE(block.text.size(), 2 * BlockReader::kBlock + BlockReader::kLongestLine);
      all += block.text;
    }
    EXPECT_EQ(reader.bytes_read(), content.size());
    return all;
  }

  const std::string file =
      (std::filesystem::path(testing::TempDir()) / ("likeness_blocks_" + std::to_string(::getpid()))).string();
};

TEST_F(BlockReaderTest, BlocksAreWholeLinesAndLoseNothing) {
  std::mt19937 random(1);
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{1000}, BlockReader::kBlock - 1,
                                 BlockReader::kBlock, BlockReader::kBlock + 1, 3 * BlockReader::kBlock + 17})
    for (const unsigned line : {1u, 2u, 40u, 5000u}) {
      std::string content;
      while (content.size() < size) content += random() % line == 0 ? '\n' : 'x';
      EXPECT_EQ(read_back(content), content) << size << " bytes, lines of " << line;
      EXPECT_EQ(read_back(content + "\n"), content + "\n");
    }
}

TEST_F(BlockReaderTest, ALineAsLongAsItMayBeIsRead) {
  const std::string line(BlockReader::kLongestLine, 'x');
  EXPECT_EQ(read_back("a\n" + line + "\nb"), "a\n" + line + "\nb");
}

TEST_F(BlockReaderTest, ALineWithoutAnEndIsRefused) {
  files::write_whole(file, "a\n" + std::string(4 * BlockReader::kLongestLine, 'x'));
  BlockReader reader(file);
  Block block;
  EXPECT_TRUE(reader.next(block));
  EXPECT_EQ(block.text, "a\n");
  EXPECT_THROW(reader.next(block), files::InputError);
}

TEST_F(BlockReaderTest, AFileThatIsNoneIsRefused) {
  EXPECT_THROW(BlockReader("no/such/file"), files::InputError);
  BlockReader folder(".");
  Block block;
  EXPECT_THROW(folder.next(block), files::InputError);
}

}  // namespace
}  // namespace likeness::eval

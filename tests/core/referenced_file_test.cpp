// SPDX-License-Identifier: MIT
#include "papilla/core/referenced_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/core/temporary_folder.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view k_png = "\x89PNG\r\n\x1a\n";

class ReferencedFile : public testing::Test {
 protected:
  ReferencedFile() {
    fs::create_directories(folder_ / "scene" / "pictures");
    write("secret.txt", "root:x:0:0");
    write("scene/pictures/a.png", k_png);
    write("scene/notes.txt", "notes");
  }
  void write(const char* name, std::string_view text) const { std::ofstream(folder_ / name, std::ios::binary) << text; }
  Reference reference(const std::string& value) const { return {folder_ / "scene", "a.gltf: at /images/0/uri", value}; }
  std::optional<fs::path> find(const std::string& value) const { return resolve_reference(reference(value)); }
  std::string refusal(const std::string& value, ReferenceContent content = ReferenceContent::any) const {
    try {
      read_reference(reference(value), content);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  }
  const TemporaryFolder folder_{"papilla-reference"};
};

TEST_F(ReferencedFile, FindsWhatLiesBesideOrBelow) {
  const fs::path picture = fs::canonical(folder_ / "scene/pictures/a.png");
  EXPECT_EQ(find("pictures/a.png"), picture);
  EXPECT_EQ(find("./pictures/../pictures/a.png"), picture);
  EXPECT_EQ(find("../scene/pictures/a.png"), picture) << "comes back into the folder";
  EXPECT_EQ(find((folder_ / "scene/pictures/a.png").string()), picture);
  fs::create_symlink("pictures/a.png", folder_ / "scene/link.png");
  EXPECT_EQ(find("link.png"), picture);
  EXPECT_EQ(find("missing.png"), std::nullopt);
  EXPECT_EQ(find("notes.txt/a.png"), std::nullopt);
  EXPECT_EQ(find(std::string(5000, 'a')), std::nullopt);
  EXPECT_EQ(find(""), std::nullopt);
}

TEST_F(ReferencedFile, TheFolderMayItselfBeReachedByALink) {
  fs::create_directory_symlink("scene", folder_ / "way");
  for (const std::string& value : {std::string("notes.txt"), (folder_ / "way/notes.txt").string()})
    EXPECT_TRUE(resolve_reference({folder_ / "way", "", value})) << value;
}

TEST_F(ReferencedFile, NothingLeadsOut) {
  fs::create_symlink(folder_ / "secret.txt", folder_ / "scene/inside.png");
  fs::create_directory_symlink("..", folder_ / "scene/up");
  fs::create_directory_symlink("/", folder_ / "scene/root");
  for (const std::string& value :
       {std::string("../secret.txt"), std::string("../../../../../../etc/passwd"), std::string("/etc/passwd"),
        std::string("pictures/../../secret.txt"), std::string("inside.png"), std::string("up/secret.txt"),
        std::string("root/etc/passwd"), std::string("../missing.txt"), std::string(".."), std::string("."),
        (folder_ / "secret.txt").string(), percent_decoded("%2e%2e/secret.txt"), percent_decoded("..%2Fsecret.txt")})
    EXPECT_EQ(refusal(value),
              "a.gltf: at /images/0/uri: '" + value + "' leads out of the folder of the file that names it");
}

TEST_F(ReferencedFile, OnlyRegularFilesAreOpened) {
  ASSERT_EQ(::mkfifo((folder_ / "scene/pipe").c_str(), 0600), 0);
  EXPECT_NE(refusal("pipe").find("'pipe' is no regular file"), std::string::npos);  // and does not wait for a writer
  EXPECT_NE(refusal("pictures").find("is no regular file"), std::string::npos);
  EXPECT_NE(refusal(std::string("pictures/a.png\0.txt", 19)).find("holds a zero byte"), std::string::npos);
}

TEST_F(ReferencedFile, ContentIsWhatItShouldBe) {
  EXPECT_EQ(read_reference(reference("pictures/a.png"), ReferenceContent::png), std::string(k_png));
  EXPECT_EQ(refusal("notes.txt", ReferenceContent::picture), "a.gltf: at /images/0/uri: 'notes.txt' is no picture");
  EXPECT_NE(refusal("notes.txt", ReferenceContent::png), "");
  EXPECT_EQ(refusal("notes.txt"), "");
  EXPECT_EQ(picture_mime_type(std::string_view("\0\0\0\x1c"
                                               "ftypavif",
                                               12)),
            "image/avif");
  EXPECT_EQ(picture_mime_type("RIFF....WEBP"), "image/webp");
  EXPECT_EQ(picture_mime_type("RIFX....WEBP"), "");
  EXPECT_EQ(picture_mime_type("\xff\xd8\xff\xe0"), "image/jpeg");
  EXPECT_EQ(picture_mime_type(""), "");
}

TEST_F(ReferencedFile, MessagesStayOnOneLineAndSteerNothing) {
  EXPECT_EQ(refusal("../\x1b[2J\n"),
            "a.gltf: at /images/0/uri: '../\\u001b[2J\\n' leads out of the folder of the file that names it");
}

TEST_F(ReferencedFile, PercentEncodingIsUndoneOnce) {
  EXPECT_EQ(percent_decoded("a%20b%C3%A4%2"), "a bä%2");
  EXPECT_EQ(percent_decoded("%252e"), "%2e");
  EXPECT_EQ(percent_decoded("%zz"), "%zz");
}

TEST_F(ReferencedFile, ReadFileWaitsForNothing) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_THROW(read_file(folder_ / "pipe"), IoError);
  EXPECT_THROW(read_file("/dev/zero"), IoError);
  EXPECT_THROW(read_file(folder_ / "scene"), IoError);
  EXPECT_EQ(read_file(folder_ / "secret.txt"), "root:x:0:0");
}

}  // namespace
}  // namespace papilla

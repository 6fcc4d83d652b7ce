// SPDX-License-Identifier: MIT
//
// sources_test: the files of a module.

#include "sources.h"
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace fs = std::filesystem;

namespace {

class Sources : public ::testing::Test {
protected:
    Sources() {
        fs::remove_all(folder_);
        fs::create_directories(folder_ / "far");
    }
    ~Sources() override { fs::remove_all(folder_); }
    fs::path write(const std::string& name, const std::string& text) {
        std::ofstream(folder_ / name) << text;
        return folder_ / name;
    }
    static std::vector<std::string> names(const std::vector<fs::path>& files) {
        std::vector<std::string> list;
        for (const fs::path& file : files)
            list.push_back(file.filename());
        return list;
    }
    fs::path folder_ = fs::temp_directory_path() / ("sources_test." + std::to_string(getpid()));
};

TEST_F(Sources, BranchesWithOneInstanceNameBringBothModules) {
    write("uart.v", "module uart;\n`ifdef LITE\n txuartlite tx (.a(b));\n`else\n txuart tx "
                    "(.a(b));\n`endif\nendmodule\n");
    write("txuart.v", "module txuart; endmodule\n");
    write("txuartlite.v", "module txuartlite; endmodule\n");
    Library library({folder_}, {});
    EXPECT_EQ(names(library.filesOf("uart")),
              (std::vector<std::string>{"txuart.v", "txuartlite.v", "uart.v"}));
}

TEST_F(Sources, FilesOutsideOfTheFoldersAreFoundWhereTheBuildNamesThem) {
    write("top.v", "module top; part u_part (.a(b)); endmodule\n");
    fs::path far = write("far/part.v", "module part; endmodule\n");
    EXPECT_EQ(names(Library({folder_}, {}).filesOf("top")), (std::vector<std::string>{"top.v"}));
    EXPECT_EQ(names(Library({folder_}, {}, {far}).filesOf("top")),
              (std::vector<std::string>{"part.v", "top.v"}));
}

} // namespace

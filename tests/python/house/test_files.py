"""Files are written whole or not at all."""

import re
import threading
from pathlib import Path

import pytest

from codesign.errors import FileError
from codesign.files import check_target, replacing, write_text


def test_a_failure_leaves_the_old_file_and_nothing_beside_it(tmp_path: Path) -> None:
    path = write_text(tmp_path / "page.html", "old")
    with pytest.raises(RuntimeError), replacing(path) as beside:
        assert beside.suffix == ".html"
        assert beside.parent == tmp_path
        beside.write_text("half")
        raise RuntimeError
    assert [file.read_text() for file in tmp_path.iterdir()] == ["old"]


def test_what_a_killed_writer_left_is_not_continued(tmp_path: Path) -> None:
    path = tmp_path / "run.sqlite"
    with replacing(path) as beside:
        beside.write_text("first")
    beside.write_text("left by a killed process")
    with replacing(path) as again:
        assert again == beside
        with again.open("a") as file:
            file.write("second")
    assert [file.read_text() for file in tmp_path.iterdir()] == ["second"]


def test_threads_that_write_one_file_do_not_meet(tmp_path: Path) -> None:
    path, together, names = tmp_path / "detail.npz", threading.Barrier(4), []

    def write(number: int) -> None:
        with replacing(path) as beside:
            names.append(beside)
            beside.write_text(str(number) * 1000)
            together.wait()

    threads = [threading.Thread(target=write, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(set(names)) == 4
    assert list(tmp_path.iterdir()) == [path]
    assert len(set(path.read_text())) == 1


def test_a_missing_folder_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=f"there is no folder {tmp_path / 'none'}") as caught:
        write_text(tmp_path / "none" / "page.html", "")
    assert caught.value.filename == str(tmp_path / "none" / "page.html")


def test_a_folder_or_a_device_is_never_replaced(tmp_path: Path) -> None:
    for target, reason in ((tmp_path, "is a folder"), (Path("/dev/null"), "is no regular file")):
        for write in (check_target, lambda path: write_text(path, "")):
            with pytest.raises(FileError, match=f"{target}: {reason}"):
                write(target)
    assert Path("/dev/null").is_char_device()


def test_a_target_is_tried_before_the_work(tmp_path: Path) -> None:
    file = write_text(tmp_path / "file", "kept")
    check_target(file)
    check_target(tmp_path / "new" / "page.html")  # its folder is made
    with pytest.raises(FileError, match=r"page.html: cannot be written"):
        check_target(file / "page.html")
    assert file.read_text() == "kept"
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["file", "new"]


def test_no_module_writes_beside_by_hand() -> None:
    package = Path(__file__).resolve().parents[3] / "python" / "codesign"
    by_hand = re.compile(r"os\.replace\(|\.rename\(|\.with_name\(f?\"\.")
    found = {str(path.relative_to(package)) for path in package.rglob("*.py") if by_hand.search(path.read_text())}
    assert not found

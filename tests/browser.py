"""Debian's chromium, headless, in which the tests open the report's page."""

import os
import shutil
from contextlib import contextmanager

import pytest

import environment


@contextmanager
def chromium():
    """Start a browser; without one the test is skipped, but in continuous integration there must be one."""
    program = shutil.which("chromium")
    if program is None:
        ((what, package),) = environment.BROWSER.values()
        message = f"{what} is missing, with which the report is tested: {environment.install_it(package)}"
        pytest.fail(message) if os.environ.get("CI") else pytest.skip(message)
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=["--disable-gpu"])
        try:
            yield browser
        finally:
            browser.close()


class Opened:
    """A page opened from disk, with its console errors and its requests."""

    def __init__(self, browser, path, **context):
        self.page = browser.new_page(**context)
        self.complaints, self.requests = [], []
        self.page.on("console", lambda said: self.complaints.append(said.text))
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.url = path.resolve().as_uri()
        self.page.goto(self.url)
        self.page.wait_for_selector("section[data-ready=yes]", state="attached")

    def section(self, name):
        """Return the section of a scene (by its address) with its picture drawn."""
        self.page.evaluate("name => document.getElementById(name).scrollIntoView()", name)
        self.page.wait_for_selector(f"#{name}[data-ready=yes]", state="attached")
        return self.page.locator(f"#{name}")

    def pixels(self, name):
        return self.page.evaluate("name => document.querySelector(`#${name} .view canvas`).toDataURL()", name)

    def frame(self, name):
        return int(self.page.get_attribute(f"#{name}", "data-frame"))

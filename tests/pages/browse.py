"""Opens a page of sagitta in a headless Chromium and holds it against its JSON report: prints what was found as one JSON document.

    browse.py PAGE.html REPORT.json [SCREENSHOT.png]

Chromium is spoken to through its pipe (--remote-debugging-pipe: JSON ended by a zero byte), so that nothing but Python is needed.
"""

import base64
import fcntl
import json
import os
import pathlib
import select
import shutil
import subprocess
import sys
import tempfile
import time

FLAGS = """--headless --no-sandbox --disable-quic --no-first-run --disable-background-networking --disable-component-update
--disable-sync --disable-extensions --disable-dev-shm-usage --use-angle=swiftshader --enable-unsafe-swiftshader --hide-scrollbars
--mute-audio --window-size=1400,1000 --remote-debugging-pipe""".split()

# Seconds that an answer may take.
PATIENCE = 60

# What is asked of the page: the pixels of the canvas.
PIXELS = """(() => {
  const view = document.getElementById('view');
  const copy = document.createElement('canvas');
  [copy.width, copy.height] = [view.width, view.height];
  const context = copy.getContext('2d');
  context.drawImage(view, 0, 0);
  const data = context.getImageData(0, 0, copy.width, copy.height).data;
  const colours = new Set();
  let drawn = 0, sum = 0;
  for (let n = 0; n < data.length; n += 4) {
    const colour = data[n] * 65536 + data[n + 1] * 256 + data[n + 2];
    colours.add(colour);
    drawn += colour !== 0xffffff;
    sum = (sum * 31 + colour) % 4294967291;
  }
  return { drawn: drawn / (data.length / 4), colours: colours.size, sum };
})()"""

CAMERA = """({ eye: sagitta.camera.position.toArray(), target: sagitta.controls.target.toArray(),
  first: report.lowest.length ? report.lowest[0].position.map((x, k) => x - origin[k]) : null })"""

NUMBERS = "[...document.querySelectorAll('[data-pointer]')].map((own) => [own.dataset.pointer, own.dataset.value])"


class Browser:
    """A Chromium with one page."""

    def __init__(self, program, profile):
        high = lambda fd: fcntl.fcntl(fd, fcntl.F_DUPFD, 20)
        theirs_in, self.to = map(high, os.pipe())
        self.back, theirs_out = map(high, os.pipe())
        connect = lambda: (os.dup2(theirs_in, 3), os.dup2(theirs_out, 4))
        command = [program, *FLAGS, f"--user-data-dir={profile}"]
        self.process = subprocess.Popen(
            command, preexec_fn=connect, pass_fds=(3, 4), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        os.close(theirs_in)
        os.close(theirs_out)
        self.buffer, self.count, self.session, self.events = b"", 0, None, []
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]

    def receive(self):
        while b"\0" not in self.buffer:
            if not select.select([self.back], [], [], PATIENCE)[0]:
                raise RuntimeError(f"Chromium has said nothing for {PATIENCE} s")
            more = os.read(self.back, 1 << 20)
            if not more:
                raise RuntimeError("Chromium has ended")
            self.buffer += more
        message, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(message)

    def ask(self, method, **parameters):
        self.count += 1
        message = {"id": self.count, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.to, json.dumps(message).encode() + b"\0")
        while True:
            answer = self.receive()
            if answer.get("id") == self.count:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]
            self.events.append(answer)

    def wait_for(self, event):
        while not any(own.get("method") == event for own in self.events):
            self.events.append(self.receive())

    def evaluate(self, expression):
        answer = self.ask("Runtime.evaluate", expression=expression, returnByValue=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(f"{expression[:60]}: {answer['exceptionDetails']}; before: {self.errors()}")
        return answer["result"].get("value")

    def errors(self):
        """What the page told of errors, and what it asked of a network."""
        found = []
        for own in self.events:
            method, told = own.get("method"), own.get("params", {})
            if method == "Runtime.exceptionThrown":
                found.append(told["exceptionDetails"].get("exception", {}).get("description", "exception"))
            elif method == "Runtime.consoleAPICalled" and told["type"] in ("error", "assert"):
                found.append(json.dumps(told["args"])[:300])
            elif method == "Log.entryAdded" and told["entry"]["level"] == "error":
                found.append(told["entry"]["text"])
            elif method == "Network.requestWillBeSent" and not told["request"]["url"].startswith(("file:", "data:", "blob:")):
                found.append("asks for " + told["request"]["url"])
        return found


def pointed(document, pointer):
    for key in pointer.split("/")[1:]:
        document = document[int(key)] if isinstance(document, list) else document.get(key)
        if document is None:
            return None
    return document


def browse(browser, page, report, screenshot):
    for domain in ("Page", "Runtime", "Log", "Network"):
        browser.ask(f"{domain}.enable")
    start = time.monotonic()
    browser.ask("Page.navigate", url=page.resolve().as_uri())
    browser.wait_for("Page.loadEventFired")
    found = {"seconds": time.monotonic() - start, "verdict": browser.evaluate("document.getElementById('verdict').textContent")}
    found["whole"], found["camera"] = browser.evaluate(PIXELS), browser.evaluate(CAMERA)
    numbers = browser.evaluate(NUMBERS)
    found["numbers"] = len(numbers)
    found["wrong"] = [own for own, value in numbers if json.loads(value) != pointed(report, own)]
    browser.evaluate("document.querySelector('[data-show=\"0\"]')?.click()")
    found["worst"], found["camera_at_worst"] = browser.evaluate(PIXELS), browser.evaluate(CAMERA)
    browser.evaluate("by('whole').click(); by('axis').value = '1'; by('axis').onchange()")
    found["cut"] = browser.evaluate(PIXELS)
    found["cut_triangles"] = browser.evaluate("cutting.children.length ? cutting.children[0].geometry.attributes.position.count / 3 : 0")
    if screenshot:
        image = browser.ask("Page.captureScreenshot", format="png", clip={"x": 0, "y": 0, "width": 1400, "height": 910, "scale": 0.7})
        pathlib.Path(screenshot).write_bytes(base64.b64decode(image["data"]))
    found["errors"] = browser.errors()
    return found


def main():
    page, report = map(pathlib.Path, sys.argv[1:3])
    program = shutil.which("chromium") or shutil.which("chromium-browser")
    if program is None:
        print(json.dumps({"missing": "chromium"}))
        return
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = Browser(program, profile)
        try:
            found = browse(browser, page, json.loads(report.read_text()), sys.argv[3] if len(sys.argv) > 3 else None)
        finally:
            browser.process.kill()
            browser.process.wait()
        print(json.dumps(found))


main()

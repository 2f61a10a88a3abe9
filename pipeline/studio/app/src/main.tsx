// Studio's page in the browser of the computer.
import { render } from 'preact';
import { App } from './app';

// The browser may be opened with the session's token behind #; the server turns it into a cookie.
const token = /^#([A-Za-z0-9_-]{16,})$/.exec(location.hash);
if (token) location.replace(`/?t=${token[1]}`);
else render(<App />, document.getElementById('app')!);

// The page on the phone. Its address holds the one-time token; everything it asks for lies beneath that address.
import { render } from 'preact';
import { PhonePage } from './phone_page';

render(<PhonePage base={location.pathname.replace(/\/+$/, '')} />, document.getElementById('app')!);

function Qh(i,t){const e=new Path2D;if(i.length===4)e.rect(i[0]*t,i[1]*t,i[2]*t,i[3]*t);else for(let n=0;n<i.length;n+=2)e.lineTo((i[n]+.5)*t,(i[n+1]+.5)*t);return i.length!==4&&e.closePath(),e}class fm{constructor(t,e,n){this.canvas=t,this.send=e,this.redraw=n,t.addEventListener("click",s=>this.active&&s.stopPropagation()),t.addEventListener("dblclick",()=>this.close()),t.addEventListener("pointerdown",s=>this.pressed(s)),t.addEventListener("pointermove",s=>this.moved(s)),t.addEventListener("pointerup",s=>this.released(s)),t.addEventListener("pointercancel",()=>this.drag=null),document.addEventListener("keydown",s=>this.key(s),{capture:!0})}masks=[];drag=null;corners=[];pointer=null;active=!1;size=[0,0];activate(t){this.active=t,this.canvas.classList.toggle("draws",t),t||(this.corners=[]),this.redraw()}take(t){JSON.stringify(t)!==JSON.stringify(this.masks)&&(this.masks=t,this.redraw())}fit(t,e){this.size=[t,e]}draw(t,e,n){t.lineWidth=1.25*n;const s=this.dragged();for(const r of s?[...this.masks,s]:this.masks)this.draw_mask(t,r,e,n);this.draw_corners(t,e,n)}draw_mask(t,e,n,s){const r=Qh(e,n);t.save(),t.fillStyle="#e0ab4a40",t.strokeStyle="#e0ab4a",t.fill(r,"evenodd"),t.stroke(r),t.clip(r,"evenodd"),t.beginPath();const{width:a,height:o}=t.canvas;for(let l=-o;l<a;l+=6*s)t.moveTo(l,o),t.lineTo(l+o,0);t.globalAlpha=.5,t.stroke(),t.restore()}draw_corners(t,e,n){if(this.corners.length!==0){t.strokeStyle=t.fillStyle="#e0ab4a",t.beginPath();for(const{px:s}of this.corners)t.lineTo((s[0]+.5)*e,(s[1]+.5)*e);this.pointer&&t.lineTo(this.pointer[0]*e,this.pointer[1]*e),t.stroke();for(const[s,{px:r}]of this.corners.entries())t.beginPath(),t.arc((r[0]+.5)*e,(r[1]+.5)*e,(s===0?4.5:3)*n,0,7),s===0?t.stroke():t.fill()}}dragged(){if(!this.drag?.far)return null;const[[t,e],[n,s]]=[this.drag.from,this.drag.to],r=[Math.floor(Math.min(t,n)),Math.floor(Math.min(e,s)),Math.ceil(Math.abs(t-n)),Math.ceil(Math.abs(e-s))];return r[2]>1&&r[3]>1?r:null}location_of(t){const e=this.canvas.getBoundingClientRect(),n=(s,r,a,o)=>Math.max(0,Math.min(o,(s-r)/a*o));return[n(t.clientX,e.left,e.width,this.size[0]),n(t.clientY,e.top,e.height,this.size[1])]}pressed(t){if(!this.active||!this.size[0]||t.button!==0)return;t.preventDefault(),document.activeElement?.blur(),this.canvas.setPointerCapture(t.pointerId);const e=this.location_of(t);this.drag={from:e,to:e,begun:[t.clientX,t.clientY],far:!1}}moved(t){if(this.pointer=this.active?this.location_of(t):null,this.drag){const{begun:e}=this.drag;this.drag.far||=this.corners.length===0&&Math.hypot(t.clientX-e[0],t.clientY-e[1])>=4,this.drag.to=this.location_of(t)}(this.drag||this.corners.length)&&this.redraw()}released(t){if(!this.drag)return;const{from:e,far:n}=this.drag,s=this.dragged();this.drag=null,s?this.add(s):n||this.clicked(e,t),this.redraw()}clicked([t,e],n){const s=this.canvas.getBoundingClientRect(),r=[n.clientX-s.left,n.clientY-s.top],a=(l,c)=>!!l&&Math.hypot(l.at[0]-r[0],l.at[1]-r[1])<c;if(this.corners.length===0){const l=this.canvas.getContext("2d");l.save(),l.resetTransform();const c=this.masks.find(h=>l.isPointInPath(Qh(h,1),t,e,"evenodd"));if(l.restore(),c)return this.send("unmask",c)}else{if(this.corners.length>=3&&a(this.corners[0],9))return this.close();if(a(this.corners[this.corners.length-1],4))return}const o=(l,c)=>Math.min(c-1,Math.floor(l));this.corners.push({px:[o(t,this.size[0]),o(e,this.size[1])],at:r}),this.corners.length===64&&this.close()}close(){if(!this.active||this.corners.length<3)return;const t=this.corners.flatMap(({px:e})=>e);this.corners=[],this.add(t),this.redraw()}add(t){this.masks=[...this.masks,t],this.send("mask",t)}key(t){this.corners.length===0||t.key!=="Enter"&&t.key!=="Escape"||t.target instanceof HTMLInputElement||(t.preventDefault(),t.stopPropagation(),t.key==="Enter"?this.close():this.corners=[],this.redraw())}}const dm=900,pm=100,ln=(i,t="",e="")=>{const n=document.createElement(i);return n.className=t,n.textContent=e,n};class jh{constructor(t,e,n){this.send=n;const s=t[0].toUpperCase()+t.slice(1);this.range.type="range",this.range.min="0",this.range.max="1000",this.range.setAttribute("aria-label",s),this.number.type="number",this.number.step="any",this.number.setAttribute("aria-label",e?`${s}, ${e}`:s),this.element.dataset.dial=t,this.element.append(ln("label","",s),this.range,this.number,ln("span","unit",e)),this.range.addEventListener("input",()=>this.turned(this.place_to_value(Number(this.range.value)/1e3))),this.number.addEventListener("input",()=>this.typing=!0),this.number.addEventListener("change",()=>{this.typing=!1,this.number.value!==""&&this.turned(Number(this.number.value))}),this.number.addEventListener("blur",()=>this.typing=!1)}element=ln("div","dial");range=ln("input");number=ln("input");touched=0;typing=!1;sent=0;waiting=0;least=0;most=1;span(t,e){this.least=t,this.most=e,this.number.min=`${t}`,this.number.max=`${e}`}show(t){performance.now()-this.touched<dm||this.typing||(this.range.value=`${Math.round(1e3*this.value_to_place(t??0))}`,this.number.value=t===null?"":`${+t.toPrecision(4)}`,this.number.placeholder=t===null?"auto":"",this.element.classList.toggle("auto",t===null))}let_go(){this.touched=0}get by_decades(){return this.least>0&&this.most/this.least>50}place_to_value(t){const e=this.by_decades?this.least*(this.most/this.least)**t:this.least+t*(this.most-this.least);return Math.min(this.most,Math.max(this.least,Number(e.toPrecision(3))))}value_to_place(t){const e=Math.min(this.most,Math.max(this.least,t));return this.most<=this.least?0:this.by_decades?Math.log(e/this.least)/Math.log(this.most/this.least):(e-this.least)/(this.most-this.least)}turned(t){this.touched=performance.now(),this.element.classList.remove("auto"),this.range.value=`${Math.round(1e3*this.value_to_place(t))}`,this.number.value=`${t}`,clearTimeout(this.waiting);const e=pm-(performance.now()-this.sent);if(e>0){this.waiting=window.setTimeout(()=>this.turned(t),e);return}this.sent=performance.now(),this.send(t)}}const Na=[.05,.1,.25,.5,1,2,4,8,16];function ge(i,t){i.textContent!==t&&(i.textContent=t)}const pa='Inter, system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "Liberation Sans", sans-serif';class mm{time=0;playing=!1;stays_at_end=!0;speed=1;labels=!0;trail_s=1;cameras=!0;rays=!1;dark=!0;selected=new Set;hidden=new Set;hover=null;range=null;listeners=[];constructor(){const t=JSON.parse(localStorage.getItem("marey")??"{}");this.dark=t.dark??!matchMedia("(prefers-color-scheme: light)").matches,this.labels=t.labels??!0,this.cameras=t.cameras??!0}on_change(t){this.listeners.push(t)}changed(){localStorage.setItem("marey",JSON.stringify({dark:this.dark,labels:this.labels,cameras:this.cameras}));for(const t of this.listeners)t()}on_hover=()=>{};changed_hover(){this.on_hover()}toggle_selected(t){this.selected.delete(t)||this.selected.add(t),this.changed()}}const gm=255,_m="Drag over a reflection in the image to mask it, or click the corners of its shape: a double click or Enter closes it, Escape leaves it. Click a mask to remove it.";let xm=class{constructor(t,e,n,s,r){this.camera=t,this.say=s,this.button.innerHTML='<svg viewBox="0 0 16 16" aria-hidden="true"><path d="M1 4h7M12 4h3M1 12h3M8 12h7"/><circle cx="10" cy="4" r="2"/><circle cx="6" cy="12" r="2"/></svg>',this.button.title="Exposure, gain, threshold and masks",this.button.setAttribute("aria-label",`Adjust ${n}`),this.threshold=new jh("threshold","",o=>this.say(`threshold ${t} ${o}`)),this.threshold.span(0,gm),this.automatic.title="Let the threshold follow from the image's noise",this.threshold.element.append(this.automatic),this.automatic.addEventListener("click",()=>{this.threshold.let_go(),s(`threshold ${t} auto`)}),this.lit.title="Masks what stands out and does not move in the next second; markers that move stay",this.lit.addEventListener("click",()=>s(`lit ${t}`)),this.none.addEventListener("click",()=>s(`unmask ${t} all`));const a=ln("div","dial masks");a.append(ln("label","","Masks"),this.count,this.lit,this.none),this.marker_rows.append(this.threshold.element,a,ln("p","hint",_m),this.found),this.panel.append(this.marker_rows,this.refused),this.panel.hidden=!0,this.panel.addEventListener("click",o=>o.stopPropagation()),this.masks=new fm(e,(o,l)=>s(`${o} ${t} ${l.join(" ")}`),r)}button=ln("button","adjust");panel=ln("div","controls");sliders=new Map;threshold;automatic=ln("button","chip","Auto");marker_rows=ln("div","markers");found=ln("span","found");lit=ln("button","chip","Mask what is lit");none=ln("button","chip","Remove all");count=ln("span","count");refused=ln("p","refused");masks;open=!1;show(t){this.open=t,this.panel.hidden=!t,this.button.setAttribute("aria-pressed",`${t}`),this.masks.activate(t&&!this.marker_rows.hidden)}take(t){for(const n of t.controls??[]){let s=this.sliders.get(n.name);s||(s=new jh(n.name,n.unit,r=>this.say(`dial ${this.camera} ${n.name} ${r}`)),this.sliders.set(n.name,s),this.marker_rows.before(s.element)),s.span(n.min,n.max),s.show(n.now)}this.marker_rows.hidden=t.threshold===void 0,this.threshold.show(t.threshold??null),this.automatic.classList.toggle("on",t.threshold===null);const e=t.masks??[];this.masks.take(e),ge(this.count,e.length?`${e.length}`:"none"),this.none.hidden=e.length===0,this.lit.disabled=t.learning??!1,ge(this.lit,t.learning?"Looking …":"Mask what is lit"),ge(this.refused,t.refused??""),this.refused.hidden=!t.refused,this.button.classList.toggle("bad",!!t.refused)}seen(t,e,n){this.masks.fit(e,n),this.open&&ge(this.found,`${t} ${t===1?"marker":"markers"} found`)}draw(t,e,n){this.masks.draw(t,e,n)}};class vm{bar=ln("div","save_bar");button=ln("button","chip on");words=ln("span");rig="";changed=!1;constructor(t,e){this.bar.append(this.words,this.button),this.bar.hidden=!0,this.button.id="save_rig",this.button.addEventListener("click",()=>e("save")),t.prepend(this.bar)}take(t,e,n){this.rig=e?.split("/").pop()??"",this.changed||=n,this.bar.hidden=!t||!this.changed,this.button.hidden=!this.rig||!n,ge(this.button,`Save to ${this.rig}`),this.rig?ge(this.words,n?"Changed, and not saved yet":`All changes are in ${this.rig}`):ge(this.words,"These changes end with the run: it has no rig file to keep them in."),this.bar.classList.toggle("unsaved",n)}}const us=16,qr=12;class Mm{cells=new Set;add(t,e,n,s){for(let r=0;r<t.length;++r){const a=Math.floor(us*(t[r]+.5)/n),o=Math.floor(qr*(e[r]+.5)/s);a>=0&&a<us&&o>=0&&o<qr&&this.cells.add(o*us+a)}}get share(){return this.cells.size/(us*qr)}draw(t,e,n){t.fillStyle="rgba(91, 168, 230, 0.18)";for(const s of this.cells){const r=Math.floor(s/us);t.fillRect((s-r*us)*e/us,r*n/qr,e/us,n/qr)}}}const tu=.01,Sm=.08,To=.15;function hd(i){const t=[];if(!i.named_bones)return t;const e=new Map;for(const n of i.tracks){const[s,r]=ym(n);e.has(s)||e.set(s,new Map),e.get(s).set(r,n.id)}for(const n of e.values())for(const[s,r]of i.named_bones){const a=n.get(s),o=n.get(r);a!==void 0&&o!==void 0&&t.push([a,o])}return t}function ym(i){const t=i.label.lastIndexOf(":")+1;return[i.label.slice(0,t),i.label.slice(t)]}function al(i,t){const e=i.sigma?i.sigma[t]:NaN;if(Number.isNaN(e))return 1;const n=Math.log(e/tu)/Math.log(Sm/tu);return Math.max(To,Math.min(1,1-(1-To)*n))}function Em(i,t,e,n,s,r,a,o){const{keypoint_x:l,keypoint_y:c,confidence:h,keypoints:u}=t;if(u===0)return;const f=e*u,d=v=>h[f+v]/255,x=v=>s(l[f+v],c[f+v]);i.lineCap="round",i.lineWidth=o;for(const[v,m]of n)d(v)===0||d(m)===0||(i.strokeStyle=r(a*Math.max(To,Math.min(d(v),d(m)))),i.beginPath(),i.moveTo(...x(v)),i.lineTo(...x(m)),i.stroke());for(let v=0;v<u;++v)d(v)!==0&&(i.fillStyle=r(a*Math.max(To,d(v))),i.beginPath(),i.arc(...x(v),1.1*o,0,7),i.fill())}class bm{constructor(t,e,n,s,r){this.number=t,this.name=e,this.size=n,this.colours=s,this.drawn=r,this.element.className="camera";const a=document.createElement("em");a.textContent=e,this.title.append(this.state,a,this.facts),this.element.append(this.canvas,this.title),this.element.tabIndex=0,this.element.addEventListener("click",()=>this.element.classList.toggle("large"))}element=document.createElement("figure");canvas=document.createElement("canvas");title=document.createElement("figcaption");state=document.createElement("b");facts=document.createElement("span");visible=!1;shown=null;decoding=!1;next=null;controls=null;over=null;covered=new Mm;bones=[];let_change(t){if(this.controls)return;const e=new xm(this.number,this.canvas,this.name,t,()=>this.draw());this.controls=e,this.title.append(e.button),this.element.append(e.panel),e.button.addEventListener("click",n=>{n.stopPropagation(),e.show(!e.open)})}adorn(t,e){this.element.append(t),this.over=e}show_state(t){this.state.className=t,this.state.title=t}status(t){if(this.show_state(t?.state??"connecting"),!t)return;this.controls?.take(t);const e=[t.state==="live"||t.state==="back"?`${(t.rate??0).toFixed(0)} Hz`:t.state];t.dropped>0&&e.push(`${t.dropped} lost`),this.covered.share>0&&!this.over&&e.push(`${Math.round(100*this.covered.share)} % covered`),this.facts.textContent=e.join(" · ")}async take(t){if(this.next=t,!this.decoding){for(this.decoding=!0;this.next;){const e=this.next;this.next=null;const n=e.jpeg?await createImageBitmap(e.jpeg).catch(()=>null):null;this.shown?.image?.close(),this.shown={shown_image:e,image:n},requestAnimationFrame(()=>{this.draw(),this.drawn(e)})}this.decoding=!1}}draw_bones(t,e,n){if(this.bones.length===0)return;const{x:s,y:r,track:a}=e.points,o=new Map;a.forEach((l,c)=>o.set(l,c));for(const[l,c]of this.bones){const h=o.get(l),u=o.get(c);h===void 0||u===void 0||(t.strokeStyle=this.colours.css(l,.8),t.beginPath(),t.moveTo(n*(s[h]+.5),n*(r[h]+.5)),t.lineTo(n*(s[u]+.5),n*(r[u]+.5)),t.stroke())}}draw(){if(!this.shown)return;const{shown_image:t,image:e}=this.shown,n=t.width||e?.width||(this.size?.[0]??640),s=t.height||e?.height||(this.size?.[1]??480);this.canvas.style.aspectRatio=`${n} / ${s}`;const r=Math.min(devicePixelRatio,2),a=Math.max(16,Math.round(this.canvas.clientWidth*r)),o=Math.round(a*s/n);(this.canvas.width!==a||this.canvas.height!==o)&&(this.canvas.width=a,this.canvas.height=o);const l=this.canvas.getContext("2d"),c=a/n;e?l.drawImage(e,0,0,a,o):(l.fillStyle="#0b0e12",l.fillRect(0,0,a,o)),this.covered.add(t.points.x,t.points.y,n,s),this.over?this.over(l,a,o,r,{...t,width:n,height:s}):this.element.classList.contains("large")&&this.covered.draw(l,a,o),l.lineWidth=1.25*r;const{points:h,boxes:u}=t;this.draw_bones(l,t,c);for(let f=0;f<h.x.length;++f)l.strokeStyle=h.track[f]?this.colours.css(h.track[f]):"#ff5d5d",l.beginPath(),l.arc(c*(h.x[f]+.5),c*(h.y[f]+.5),3.2*r,0,7),l.stroke();this.controls?.seen(h.x.length,n,s),this.controls?.draw(l,c,r);for(let f=0;f<u.left.length;++f)l.strokeStyle=this.colours.css(u.track[f]),l.strokeRect(c*u.left[f],c*u.top[f],c*u.width[f],c*u.height[f])}}class wm{constructor(t,e,n,s){this.chosen=t,this.colours=e,this.say=n,this.drawn=s,this.watcher=new IntersectionObserver(r=>{for(const a of r){const o=this.tiles.find(l=>l.element===a.target);o&&(o.visible=a.isIntersecting)}this.ask()}),new ResizeObserver(()=>this.ask()).observe(this.grid),this.chosen}grid=document.querySelector("#cameras");tiles=[];watched="";scene=null;save_bar=new vm(this.grid.parentElement,t=>this.say(t));also=null;watcher;take(t){this.scene=t;const e=hd(t);for(const n of this.tiles)n.bones=e;if(!(this.tiles.length===t.cameras.length&&t.cameras.length>0)){this.watcher.disconnect(),this.tiles=t.cameras.map((n,s)=>new bm(s,n.name,n.size,this.colours,this.drawn)),this.grid.replaceChildren(...this.tiles.map(n=>n.element));for(const n of this.tiles)n.bones=e,t.can_change&&n.let_change(this.say),this.watcher.observe(n.element)}}adorn(t,e,n){return this.tiles[t]?.adorn(e,n),t in this.tiles}state(t,e){this.tiles[t]?.show_state(e)}shown_image(t){this.tiles[t.camera]?.take(t)}status(t,e){this.save_bar.take(this.scene?.can_change??!1,this.scene?.rig_file,e),this.tiles.forEach((n,s)=>n.status(t[s]))}ask(t=!1){const e=Math.min(devicePixelRatio,2),n=o=>Math.min(4096,Math.max(64,32*Math.ceil(o*e/32))),s=new Map;for(const o of this.tiles)o.visible&&s.set(o.number,n(o.canvas.clientWidth));this.also&&s.set(this.also.camera,Math.max(n(this.also.width/e),s.get(this.also.camera)??0));const a=`watch ${(document.hidden?[]:[...s].map(([o,l])=>`${o} ${l}`)).join(" ")}`;a===this.watched&&!t||(this.watched=a,this.say(a))}}const ud=i=>i[0].toLowerCase()==="l"?"left":"right",ol=i=>i.slice(i.lastIndexOf(":")+1).trim();function Tm(i){const t=/^(left|right)/i.exec(i)??/[_. -](left|right)/i.exec(i)??/[a-z0-9](Left|Right)(?![a-z])/.exec(i)??/(?:^|[_. -])([lr])(?:$|[_. -])/i.exec(i)??/(?:^|[_. -])([LR])[A-Z]/.exec(i);return t?ud(t[1]):null}function Am(i){const t=new Set(i.map(n=>ol(n).toLowerCase())),e=n=>{const s=n.toLowerCase();return/^[lr][a-z]{2}/.test(s)&&t.has((s[0]==="l"?"r":"l")+s.slice(1))?ud(s):null};return new Map(i.map(n=>[n,Tm(ol(n))??e(ol(n))]))}const eu=[.96,.52,.36],nu=[.33,.72,.9],iu=[.93,.83,.55],ll=[[.3,.62,.95],[.95,.42,.4],[.98,.8,.35],[.62,.8,.45]],su={white:[.92,.93,.95],black:[.24,.26,.3],red:[.9,.33,.32],blue:[.3,.58,.95],yellow:[.96,.82,.3],green:[.36,.74,.42],orange:[.96,.6,.26],referee:[.98,.8,.35]};function Rm(i,t,e){const n=t*Math.min(e,1-e),s=r=>{const a=(r+i*12)%12;return e-n*Math.max(-1,Math.min(a-3,9-a,1))};return[s(0),s(8),s(4)]}function ru(i){return Rm((i*137.50776+205)%360/360,.62,.6+.07*(i%3-1))}class Cm{of=new Map;sides=!1;side=new Map;teams=[];frame="space";dark=null;take(t){this.of.clear(),this.frame=t.frame;const e=t.tracks.filter(o=>o.label!=="");this.side=Am(e.map(o=>o.label));const n=o=>e.filter(l=>this.side.get(l.label)===o).length,[s,r]=[n("left"),n("right")];this.sides=t.frame==="space"&&Math.min(s,r)>=.15*e.length&&e.length>3;const a=new Map;for(const o of t.tracks)o.team!==""&&a.set(o.team,(a.get(o.team)??0)+1);this.teams=[...a.keys()].sort((o,l)=>a.get(l)-a.get(o)||o.localeCompare(l)),this.teams=[...this.teams.slice(0,2).sort(),...this.teams.slice(2)];for(const o of t.tracks)this.of.set(o.id,this.chosen(o))}rgb(t){let e=this.of.get(t);return e||this.of.set(t,e=ru(t)),this.shown(e)}shown([t,e,n]){if(this.dark!==!1)return[t,e,n];const s=1-.42*Math.max(0,.299*t+.587*e+.114*n-.35)/.65;return[s*t,s*e,s*n]}css(t,e=1){const[n,s,r]=this.rgb(t);return`rgba(${Math.round(255*n)},${Math.round(255*s)},${Math.round(255*r)},${e})`}is_light(t){const[e,n,s]=this.rgb(t);return .299*e+.587*n+.114*s>.55}legend(){const t=e=>`rgb(${this.shown(e).map(n=>Math.round(255*n)).join(",")})`;return this.sides?[["left",t(eu)],["right",t(nu)],["middle",t(iu)]]:this.frame==="ground"?this.teams.slice(0,4).map((e,n)=>[e,t(su[e.toLowerCase()]??ll[n])]):[]}chosen(t){if(t.colour)return t.colour.map(n=>n/255);const e=this.teams.indexOf(t.team);return t.team!==""&&e>=0&&e<ll.length?su[t.team.toLowerCase()]??ll[e]:this.sides?{left:eu,right:nu,middle:iu}[this.side.get(t.label)??"middle"]:ru(t.id)}}const au=["rename","swap","split","join","delete","fill","filter"],Pm={rename:[1,1],swap:[2,2],split:[1,1],join:[2,2],delete:[1,1/0],fill:[0,1/0],filter:[0,1/0]},_s=i=>i.label===""?`#${i.id}`:i.label;function Kr(i,t){const{label:e,id:n}=i;return e===""||e.startsWith("#")||/["\x00-\x1f]/.test(e)||t.some(s=>s!==i&&s.label===e)?`#${n}`:/[\s,]/.test(e)?`"${e}"`:e}const cl=i=>{const t=i.slice(0,4).map(_s);return i.length>4?`${t.slice(0,3).join(", ")} and ${i.length-3} more`:t.length<2?t.join(""):`${t.slice(0,-1).join(", ")} and ${t[t.length-1]}`},ou=i=>/^[\w./-]+$/.test(i)?i:`'${i.replaceAll("'","'\\''")}'`,po=i=>i.tracks.length===0||i.tracks.length===i.all.length,lu=i=>/^[\w.-]+$/.test(i)?i:`"${i}"`;function hl(i){const[t,e]=Pm[i.kind],n=i.tracks.length;return n<t||n>e?`Select ${t===e?t===1?"one":"two":"at least one"} in the view or in the list${n>e?`; ${n} are selected`:""}.`:i.name.includes('"')?'A name cannot hold a ".':i.kind==="rename"&&i.name.trim()===""?`What is ${_s(i.tracks[0])} to be called?`:""}function cu(i){const{tracks:t,all:e,kind:n}=i,s=i.range?` ${i.range.first}:${i.range.last}`:"",r=()=>t.map(c=>Kr(c,e)).join(","),a=i.name.trim();if(n==="rename")return`rename ${r()} ${lu(a)}`;if(n==="swap")return`swap ${Kr(t[0],e)} ${Kr(t[1],e)}${s}`;if(n==="split")return`split ${r()} ${i.frame}${a?` ${lu(a)}`:""}`;if(n==="join")return`join ${Kr(t[0],e)} ${Kr(t[1],e)}`;if(n==="delete")return`delete ${r()}${s}`;const o=po(i)?"all":r();if(n==="filter")return`filter ${o} ${i.cutoff.trim()||"auto"}${s}`;const l=[i.method,i.longest.trim()&&`longest=${i.longest.trim()}`,i.within.trim()&&`within=${i.within.trim()}`];return`fill ${o}${s}${l.filter(Boolean).map(c=>` ${c}`).join("")}`}function Lm(i,t){const{tracks:e,range:n}=i,s=n?n.first===n.last?`in frame ${n.first}`:`in frames ${n.first} to ${n.last}`:"in all frames",r=po(i)?`all ${i.all.length} ${t}`:cl(e);switch(i.kind){case"rename":return`${_s(e[0])} is called ${i.name.trim()}, in all frames.`;case"swap":return`${_s(e[0])} and ${_s(e[1])} exchange what they have ${s}.`;case"split":return`From frame ${i.frame} on, which is shown, ${_s(e[0])} is a track of its own${i.name.trim()?`, called ${i.name.trim()}`:""}.`;case"join":return`${_s(e[0])} gets all that ${_s(e[1])} has, which is there no more.`;case"delete":return n?`What ${cl(e)} ${e.length>1?"have":"has"} ${s} is left out.`:`${cl(e)} ${e.length>1?"are":"is"} left out of the take.`;case"fill":{const a=i.method?`by ${i.method}`:"each by the method that does best on holes like it";return`Gaps of ${r} ${s} are filled, ${a}; those over ${i.longest.trim()||1} s, or expected to be off by over ${i.within.trim()||50} mm, stay open.`}case"filter":return`The ${po(i)||e.length>1?"paths":"path"} of ${r} ${po(i)||e.length>1?"are":"is"} smoothed ${s}, with ${i.cutoff.trim()?`a cut-off of ${i.cutoff.trim()} Hz`:"the cut-off that fits the noise of each"}.`}}const Ji=i=>i.chunk.time[i.k];function mo(i,t){let e=0,n=i.length;for(;e<n;){const s=e+n>>1;i[s]<=t?e=s+1:n=s}return e-1}function Mr(i,t){const e=i.at(t);return e?e.chunk.index[e.k]:Math.max(0,Math.round((t-i.first)*i.scene.rate))}function jl(i,t){const e=Math.max(.1,i.scene.rate);let n=i.first+(t-Mr(i,i.first))/e;for(let s=0;s<4;++s){const r=i.at(Math.max(i.first,Math.min(i.last,n)));if(!r)break;const a=t-r.chunk.index[r.k];if(n=Ji(r)+a/e,a===0)break}return n}function fd(i,t){return[jl(i,t.first),jl(i,t.last)+1/Math.max(.1,i.scene.rate)]}function dd(i,t,e){return{first:Mr(i,Math.min(t,e)),last:Mr(i,Math.max(t,e))}}const ul=300,qn=(i,t,e="")=>Object.assign(document.createElement(i),{className:t,textContent:e});class Dm{constructor(t,e){this.go=t,this.show=e}list=document.querySelector("#edits");draw(t){const e=[this.row(0,"as it was recorded",t.head===0,!0,"")];let n=0;for(const s of t.edits){const r=s.parent??0,a=r===n?"":r===0?"a branch from the recording":`a branch from ${r}`,o=this.row(s.id,s.description,t.head===s.id,s.active,a);s.gaps?.length&&o.append(this.gaps(s)),e.push(o),n=s.id}this.list.replaceChildren(...e),this.show_head()}show_head(){this.list.querySelector(".head")?.scrollIntoView({block:"nearest"})}row(t,e,n,s,r){const a=qn("li",`edit${n?" head":""}${s?"":" undone"}`);a.dataset.id=`${t}`;const o=qn("button","go");o.title=n?"This is what is shown":t===0?"Show it as it was recorded":"Let the edits up to this one count",o.setAttribute("aria-current",`${n}`);const l=qn("span","words",e);return r&&l.append(qn("em","",r)),o.append(qn("span","number",t===0?"":`${t}`),l),o.addEventListener("click",()=>n||this.go(t)),a.append(o),a}gaps(t){const e=t.gaps,n=qn("details","gaps");n.append(qn("summary","",e.length===1?"the gap":`the ${e.length} gaps`));for(const s of e.slice(0,ul)){const r=qn("button","gap");r.title="Show its beginning",r.append(qn("span","",s.track),qn("span","",s.first===s.last?`${s.first}`:`${s.first} – ${s.last}`)),r.append(qn("span","",s.method),qn("b","",`${s.expected_mm.toFixed(1)} mm`)),r.addEventListener("click",()=>this.show(s.first)),n.append(r)}return e.length>ul&&n.append(qn("span","gap",`and ${e.length-ul} more`)),n}}const Ze=i=>document.querySelector(`#${i}`),Kn=i=>Ze(i),hu=i=>`${i[0].toUpperCase()}${i.slice(1)}`,Nm=4e3,uu={n:"rename",w:"swap",s:"split",j:"join",Delete:"delete",f:"fill",b:"filter"};class Im{constructor(t,e,n){this.state=t,this.motion=e,this.around=n,this.list=new Dm(r=>this.ask("go",` ${r}`),r=>n.seek(jl(e(),r)));const s=(r,a)=>Ze(r).addEventListener("click",a);for(const r of au)s(`do_${r}`,()=>this.choose(r));s("mark_in",()=>this.mark("first")),s("mark_out",()=>this.mark("last")),s("mark_none",()=>this.set_range(null)),s("undo",()=>this.ask("undo")),s("redo",()=>this.ask("redo")),s("other_way",()=>{this.reversed=!this.reversed,this.tell()});for(const r of["range_first","range_last"])Kn(r).addEventListener("change",()=>this.take_range());Ze("act").addEventListener("input",()=>this.tell()),Ze("act").addEventListener("submit",r=>{r.preventDefault(),this.act()}),t.on_change(()=>this.tell())}allowed=!1;kind=null;reversed=!1;history={edits:[],head:0,newest:0};list;pending=null;fetching=Promise.resolve();take(t){if(this.allowed=t.can_edit??!1,document.body.classList.toggle("editing",this.allowed),!this.allowed||!t.complete)return;const e=new Set(t.tracks.map(s=>s.id)),n=[...this.state.selected].filter(s=>!e.has(s));for(const s of n)this.state.selected.delete(s);n.length&&this.state.changed(),this.tell()}found(){this.allowed&&this.refresh()}hear(t,e){if(t==="edits")this.refresh();else if(t==="done")this.refresh().then(()=>this.answered(""));else if(t==="refused")this.refresh().then(()=>this.answered(e||"that cannot be done"));else return!1;return!0}opened(){this.list.show_head()}lost(){this.pending=null,this.tell()}refresh(){const t=this.fetching.then(async()=>{try{this.history=await(await fetch("edits")).json()}catch{return}this.list.draw(this.history),this.tell()});return this.fetching=t,t}answered(t){const e=this.pending;this.pending=null;const n=this.history.edits.find(r=>r.id===this.history.head),s=n?`as after ${n.id}: ${n.description}`:"as it was recorded";t?this.said(`Not done. ${hu(t)}${/[.?!]$/.test(t)?"":"."}`,!1):this.said(e==="edit"&&n?`Done: ${n.description}.`:`Now ${s}.`,!0),t||(this.kind=null),this.tell()}said(t,e){const n=Ze("edit_said");n.textContent=t,n.hidden=t==="",n.classList.toggle("refused",!e)}get frame(){return Mr(this.motion(),this.state.time)}get what(){return{space:"markers",ground:"people",image:"tracks"}[this.motion().scene.frame]}request(t){const{scene:e}=this.motion(),n=new Map(e.tracks.map(a=>[a.id,a])),s=[...this.state.selected].flatMap(a=>n.get(a)??[]);this.reversed&&t==="join"&&s.reverse();const r=t==="rename"||t==="split";return{kind:t,tracks:s,all:e.tracks,range:this.state.range,frame:this.frame,name:r?Kn("new_name").value:"",method:Kn("fill_method").value,longest:Kn("fill_longest").value,within:Kn("fill_within").value,cutoff:Kn("cutoff").value}}draw(){if(!this.allowed)return;const t=`frame ${this.frame}`;Ze("frame_now").textContent!==t&&(ge(Ze("frame_now"),t),this.kind==="split"&&this.tell())}tell(){if(!this.allowed)return;const{range:t,selected:e}=this.state,{kind:n,history:s}=this;for(const r of["first","last"])document.activeElement!==Ze(`range_${r}`)&&(Kn(`range_${r}`).value=t&&t.open!==r?`${t[r]}`:"");Ze("mark_none").disabled=!t;for(const r of au){const a=Ze(`do_${r}`);a.classList.toggle("on",n===r),a.classList.toggle("dim",hl({...this.request(r),name:"x"})!==""),a.setAttribute("aria-pressed",`${n===r}`)}Ze("edit_hint").hidden=n!==null||!Ze("edit_said").hidden,ge(Ze("edit_hint"),`${e.size?"":`Select ${this.what} in the view or in the list. `}Mark frames with In and Out, where it is not for all of them, and choose what to do. Nothing recorded is ever changed: all of it can be undone.`),Ze("act").hidden=n===null,n&&this.tell_act(n),Ze("undo").disabled=s.head===0||this.pending!==null,Ze("redo").disabled=!s.edits.some(r=>(r.parent??0)===s.head)||this.pending!==null,ge(Ze("edits_count"),s.edits.length?`${s.edits.length}`:"")}tell_act(t){const e=this.request(t),n=hl(e);ge(Ze("act_words"),n||Lm(e,this.what)),Ze("act_words").classList.toggle("lacks",n!==""),ge(Ze("act_command"),n?"":`marey edit ${ou(this.motion().scene.name)} ${ou(cu(e))}`),Ze("act_command").hidden=n!=="";for(const r of document.querySelectorAll("#act [data-of]"))r.hidden=!r.dataset.of.split(" ").includes(t);Kn("new_name").placeholder=t==="split"?"its name, where it is to have one":"its new name";const s=Ze("act_do");ge(s.firstElementChild,this.pending?"…":hu(t)),s.disabled=n!==""||this.pending!==null||!this.motion().scene.complete}mark(t){const{frame:e}=this,n={...this.state.range??{first:e,last:e}};n[t]=e,n.open===t&&delete n.open,n.first>n.last&&(n[t==="first"?"last":"first"]=e),this.set_range(n)}set_range(t){this.state.range=t,this.state.changed()}take_range(){const[t,e]=["range_first","range_last"].map(c=>Math.round(Number(Kn(c).value||NaN))),n=this.motion(),[s,r]=[Mr(n,n.first),Mr(n,n.last)];if(["range_first","range_last"].map(c=>Kn(c).value.trim()).some(c=>c!==""&&!/^\d+$/.test(c)))return this.refuse_range("A frame is a whole number.");if(Number.isNaN(t)&&Number.isNaN(e))return this.set_range(null);const o=[Number.isNaN(t)?s:t,Number.isNaN(e)?r:e];if(o.some(c=>c<s||c>r))return this.refuse_range(`Frames are from ${s} to ${r}.`);if(o[0]>o[1])return this.refuse_range(`Frame ${o[0]} is after frame ${o[1]}.`);this.said("",!0);const l=Number.isNaN(e)?"last":Number.isNaN(t)?"first":void 0;this.set_range({first:o[0],last:o[1],open:l})}refuse_range(t){const{range:e}=this.state;for(const n of["first","last"])Kn(`range_${n}`).value=e&&e.open!==n?`${e[n]}`:"";this.said(`Range not set. ${t}`,!1),this.tell()}choose(t){this.kind=this.kind===t?null:t,this.reversed=!1,this.said("",!0),Kn("new_name").value="",this.tell(),this.kind&&document.querySelector("#edit").offsetParent===null&&this.around.show_tab("edits"),this.kind==="rename"&&this.state.selected.size===1&&Kn("new_name").focus()}act(){if(!this.kind)return;const t=this.request(this.kind);hl(t)===""&&this.ask("edit",` ${cu(t)}`)}ask(t,e=""){if(!this.allowed||this.pending)return;const n=`${t} ${this.history.head} ${this.history.newest}${e}`;if(new TextEncoder().encode(n).length>Nm)return this.said("Not done. This many names are more than the page can send; write it as marey edit on the command line.",!1);if(!this.around.send(n))return this.said("Not done. The program that shows this does not answer.",!1);this.pending=t,document.activeElement?.blur?.(),this.tell()}key(t){if(!this.allowed||t.altKey||document.querySelector("dialog[open]"))return!1;const e=t.target instanceof HTMLInputElement||t.target instanceof HTMLSelectElement,n=t.key.length===1?t.key.toLowerCase():t.key,s=t.ctrlKey||t.metaKey?this.with_control(n,t.shiftKey):this.plain(n);return!s||e&&n!=="Escape"||t.target instanceof HTMLButtonElement&&n==="Enter"?!1:(t.preventDefault(),s(),!0)}with_control(t,e){return t==="z"?()=>this.ask(e?"redo":"undo"):t==="y"?()=>this.ask("redo"):null}plain(t){return t in uu?()=>this.choose(uu[t]):t==="i"?()=>this.mark("first"):t==="o"?()=>this.mark("last"):t==="u"?()=>this.set_range(null):t==="e"?()=>this.around.show_tab("edits"):t==="Enter"&&this.kind?()=>this.act():t!=="Escape"||!this.kind?null:()=>{document.activeElement?.blur?.(),this.choose(null)}}}const Ia=i=>document.querySelector(`#${i}`);function Um(i){document.addEventListener("keydown",t=>Fm(i,t)),document.addEventListener("click",t=>t.detail>0&&t.target.closest("button")?.blur())}function Fm(i,t){const{state:e,seek:n,step:s}=i;if(i.editor.key(t)||t.ctrlKey||t.metaKey||t.altKey||t.target instanceof HTMLInputElement&&t.key!=="Escape"||t.target instanceof HTMLSelectElement||t.target instanceof HTMLButtonElement&&(t.key===" "||t.key==="Enter")||Ia("keys").open)return;const r=l=>Ia(l).hidden||Ia(l).click(),o={" ":()=>i.timeline.toggle(),ArrowLeft:()=>t.shiftKey?n(e.time-1):s(-1),ArrowRight:()=>t.shiftKey?n(e.time+1):s(1),ArrowUp:()=>i.timeline.faster(1),ArrowDown:()=>i.timeline.faster(-1),Home:()=>i.go_to("first"),End:()=>i.go_to("last"),l:()=>r("labels"),t:()=>r("trails"),c:()=>r("rig"),y:()=>r("rays"),d:()=>r("theme"),r:()=>r("record"),1:()=>r("top"),2:()=>r("front"),3:()=>r("side"),0:()=>r("reset"),"?":()=>r("help"),n:()=>i.names.focus(),m:()=>i.show_tab("list"),p:()=>i.show_tab("plot"),v:()=>Ia("pictures_tab").hidden||i.show_tab("pictures"),a:()=>{const l=e.selected.size<i.scene().tracks.length;e.selected=new Set(l?i.scene().tracks.map(c=>c.id):[]),e.changed()},Escape:()=>r("none")}[t.key.length===1?t.key.toLowerCase():t.key];o&&(t.preventDefault(),o())}const Om=330;class km{pings=new Map;count=0;offset=null;ms=[];ping(){return this.pings.set(++this.count,performance.now()),[`ping ${this.count}`,this.count<8?150:4e3]}pong(t){const[e,n]=t.split(" "),s=this.pings.get(Number(e));if(this.pings.delete(Number(e)),s===void 0)return;const r=performance.now(),a=r-s;this.offset&&a>this.offset.trip*1.02||(this.offset={ms:Number(BigInt(n)/1000n)/1e3-(s+r)/2,trip:a})}drawn(t){!this.offset||document.hidden||(this.ms.push(performance.now()+this.offset.ms-t),this.ms.length>Om&&this.ms.splice(0,30),this.ms.length%30===0&&(document.body.dataset.latency=`${this.of(.95)?.toFixed(1)}`))}of(t){if(this.ms.length<10)return null;const e=[...this.ms].sort((n,s)=>n-s);return e[Math.min(e.length-1,Math.floor(t*e.length))]}}const fu=60,Bm=15e3,zm=2,Hm=10;class vs{revision=0;scene;on_change=()=>{};times=[];here=[];place=new Map;gone=0;seen_at=new Map;constructor(t){this.scene=t}get first(){return this.times.length?Math.max(this.times[0],this.last-fu):0}get last(){return this.times[this.times.length-1]??0}take(t){this.scene=t,this.on_change()}add(t){t.time[0]<this.last-1&&this.forget(),this.place.set(t,this.gone+this.here.length),this.times.push(t.time[0]),this.here.push(t);for(const e of t.track)this.seen_at.set(e,t.time[0]);if(this.here.length>Bm||this.here.length>400&&this.times[200]<this.last-fu){for(const n of this.here.splice(0,200))this.place.delete(n);this.times.splice(0,200),this.gone+=200}this.on_change()}at(t){const e=Math.max(0,mo(this.times,t+1e-9));return e<this.here.length?{chunk:this.here[e],k:0}:null}neighbour(t,e){const n=this.place.get(t.chunk),s=n===void 0?void 0:this.here[n-this.gone+e];return s?{chunk:s,k:0}:null}async course(t){const e=[];let n=!1;for(const r of this.here){const a=r.track.indexOf(t);a<0||(n=r.z!==null,e.push([r.time[0],r.x[a],r.y[a],r.z?r.z[a]:0,r.state[a]]))}const s=r=>Float32Array.from(e,a=>a[r]);return{time:Float64Array.from(e,r=>r[0]),x:s(1),y:s(2),z:n?s(3):null,state:Uint8Array.from(e,r=>r[4])}}density(){const t=Math.max(1,Math.floor(this.here.length/600)),e=[];for(let n=0;n<this.here.length;n+=t)e.push([this.times[n],this.here[n].track.length]);return e}seen(t){if(this.here.length===0)return null;let e=0,n=0;for(let s=Math.max(0,this.here.length-600);s<this.here.length;++s){++n;const r=this.here[s].track.indexOf(t);r>=0&&this.here[s].provenance(r)===0&&++e}return e/n}absent(t){return this.last-(this.seen_at.get(t)??-1/0)}is_there(t){return this.absent(t)<=zm}is_listed(t){return this.absent(t)<=Hm}count(){return[...this.seen_at.keys()].filter(t=>this.is_there(t)).length}rate(){const t=Math.min(60,this.times.length-1);if(t<2)return 0;const e=this.last-this.times[this.times.length-1-t];return e>0?t/e:0}forget(){this.gone+=this.here.length,this.here=[],this.times=[],this.place.clear(),this.seen_at.clear()}}function pd(i){return i.kind==="recording"&&i.tracks.length>0&&i.tracks.every(t=>!t.measured)}function wr(i,t){return i&&i.label!==""?i.label:`${t}`}const Ua=64;class Gm{constructor(t,e,n){this.state=e,this.say=n,this.form.id="naming",this.form.hidden=!0,this.field.id="name_field",this.field.maxLength=Ua,this.field.addEventListener("input",()=>this.limit()),this.field.placeholder="its name",this.field.autocomplete="off",this.field.spellcheck=!1,this.title.htmlFor="name_field";const s=document.createElement("button");s.className="chip on",s.textContent="Name it",this.full.textContent=`${Ua} letters at most`,this.full.hidden=!0,this.form.append(this.title,this.field,s,this.full),this.form.addEventListener("submit",r=>{r.preventDefault(),this.give()}),t.append(this.form),e.on_change(()=>this.update())}form=document.createElement("form");title=document.createElement("label");field=document.createElement("input");full=document.createElement("span");scene=null;shown=null;take(t){this.scene=t,this.update()}focus(){this.form.hidden||this.field.select()}update(){const{scene:t,state:e}=this,n=t?.kind==="live"&&t.can_change&&e.selected.size===1?[...e.selected][0]:null;if(this.form.hidden=n===null,n===null||!t){this.shown=null;return}const s=t.tracks.find(r=>r.id===n);this.title.textContent=`${t.frame==="space"?"Marker":"Track"} ${wr(s,n)}`,this.shown!==n&&(this.shown=n,this.field.value=s?.label??"",this.limit())}limit(){const t=n=>new TextEncoder().encode(n).length,e=[...this.field.value];for(;t(e.join(""))>Ua;)e.pop();e.join("")!==this.field.value&&(this.field.value=e.join("")),this.full.hidden=t(this.field.value)<Ua}give(){this.shown!==null&&(this.say(`name ${this.shown} ${this.field.value.trim()}`),this.field.blur())}}function Vm(i,t){let e=null;const n=s=>{const r=i.element.getBoundingClientRect();return[s.clientX-r.left,s.clientY-r.top]};i.element.addEventListener("pointerdown",s=>e=n(s),{capture:!0}),i.element.addEventListener("pointerup",s=>{const r=n(s);if(!e||Math.hypot(r[0]-e[0],r[1]-e[1])>5)return;const a=i.overlay.hit(...r,s.pointerType==="touch"?22:12);a!==null&&t.toggle_selected(a)}),i.element.addEventListener("pointermove",s=>{if(s.buttons)return;const r=i.overlay.hit(...n(s),10);i.element.classList.toggle("over_mark",r!==null),r!==t.hover&&(t.hover=r,t.changed_hover())})}const Zr=15,Wm=(i,t)=>i.left<t.right&&t.left<i.right&&i.top<t.bottom&&t.top<i.bottom;class Xm{cells=new Map;each(t,e){for(let n=Math.floor(t.left/64);n<=Math.floor(t.right/64);++n)for(let s=Math.floor(t.top/64);s<=Math.floor(t.bottom/64);++s)e(n*4096+s)}add(t){this.each(t,e=>{const n=this.cells.get(e);n?n.push(t):this.cells.set(e,[t])})}free(t){let e=!0;return this.each(t,n=>{e&&this.cells.get(n)?.some(s=>Wm(t,s))&&(e=!1)}),e}}class jc{constructor(t,e){this.state=t,this.colours=e,this.draw=this.canvas.getContext("2d")}canvas=document.createElement("canvas");draw;width=1;height=1;widths=new Map;last=[];resize(t,e){const n=Math.min(devicePixelRatio,2);this.width=t,this.height=e,this.canvas.width=Math.round(t*n),this.canvas.height=Math.round(e*n),this.canvas.style.width=`${t}px`,this.canvas.style.height=`${e}px`,this.draw.setTransform(n,0,0,n,0,0)}clear(){this.draw.clearRect(0,0,this.width,this.height)}labels(t,e){this.last=t;const{state:n,draw:s}=this,r=new Xm;for(const l of t)r.add({left:l.x-l.radius,right:l.x+l.radius,top:l.y-l.radius,bottom:l.y+l.radius});const a=l=>n.selected.has(l.id)||n.hover===l.id,o=t.filter(l=>l.text!==""&&(e||a(l))).sort((l,c)=>Number(a(c))-Number(a(l))||l.depth-c.depth);s.font=`500 11.5px ${pa}`,s.textBaseline="middle";for(const l of o){const c=this.text_width(l.text)+6,h=this.place(l,c,r,a(l));h&&(r.add(h),this.tag(l,h,a(l)))}}hit(t,e,n=14){let s=n*n,r=null;for(const a of this.last){const o=(a.x-t)**2+(a.y-e)**2-a.radius**2;o<s&&(s=o,r=a.id)}return r}place(t,e,n,s){const r=t.radius+3,a=(c,h)=>({left:c,top:h,right:c+e,bottom:h+Zr}),o=[a(t.x+r,t.y-Zr/2),a(t.x-r-e,t.y-Zr/2),a(t.x-e/2,t.y-r-Zr),a(t.x-e/2,t.y+r)],l=c=>c.left>=2&&c.top>=2&&c.right<=this.width-2&&c.bottom<=this.height-2;return o.find(c=>l(c)&&n.free(c))??(s?o[0]:null)}tag(t,e,n){const{draw:s,state:r}=this,a=(e.top+e.bottom)/2+.5;n?(s.fillStyle=this.colours.css(t.id),s.beginPath(),s.roundRect(e.left,e.top,e.right-e.left,Zr,3),s.fill(),s.fillStyle=this.colours.is_light(t.id)?"#14181d":"#fff"):(s.lineWidth=3,s.lineJoin="round",s.strokeStyle=r.dark?"rgba(14,17,21,.75)":"rgba(255,255,255,.85)",s.strokeText(t.text,e.left+3,a),s.fillStyle=r.dark?"#c9d1da":"#3a444f"),s.fillText(t.text,e.left+3,a)}text_width(t){let e=this.widths.get(t);return e===void 0&&(e=this.draw.measureText(t).width,this.widths.size>5e3&&this.widths.clear(),this.widths.set(t,e)),e}}function md(i,t,e,n){const s=[t],r=Ji(t)-e,a=e/n;let o=Ji(t);for(let l=i.neighbour(t,-1);l&&Ji(l)>=r;l=i.neighbour(l,-1))o-Ji(l)<a-1e-9||(o=Ji(l),s.push(l));return s}const $m=120;class go{constructor(t,e,n){this.state=t,this.colours=e,this.redraw=n,this.overlay=new jc(t,e),this.element.className="view plane",this.element.append(this.base,this.overlay.canvas),this.element.addEventListener("wheel",s=>this.wheel(s),{passive:!1}),this.element.addEventListener("pointerdown",s=>this.fingers.set(s.pointerId,[s.offsetX,s.offsetY])),this.element.addEventListener("pointermove",s=>this.drag(s));for(const s of["pointerup","pointercancel","pointerleave"])this.element.addEventListener(s,r=>this.fingers.delete(r.pointerId))}element=document.createElement("div");overlay;base=document.createElement("canvas");tracks=new Map;scene=null;width=1;height=1;low=[0,0];high=[1,1];scale=1;origin=[0,0];fitted=!0;fingers=new Map;video_image=null;get pixels_wide(){return Math.round((this.high[0]-this.low[0])*this.scale*Math.min(devicePixelRatio,2))}take(t){this.scene=t,this.tracks=new Map(t.tracks.map(n=>[n.id,n]));const e=`${this.low},${this.high}`;if(t.frame==="image"){const n=t.size??[t.high?.[0]??640,t.high?.[1]??480];this.low=[-.5,-.5],this.high=[n[0]-.5,n[1]-.5]}else if(t.pitch){const{x:n,y:s,length:r,width:a}=t.pitch;this.low=[n-4,s-4],this.high=[n+r+4,s+a+4]}else if(t.low&&t.high){const n=.06*Math.max(t.high[0]-t.low[0],t.high[1]-t.low[1],1);this.low=[t.low[0]-n,t.low[1]-n],this.high=[t.high[0]+n,t.high[1]+n]}this.fitted&&e!==`${this.low},${this.high}`&&this.reset()}resize(t,e){this.width=t,this.height=e;const n=Math.min(devicePixelRatio,2);this.base.width=Math.round(t*n),this.base.height=Math.round(e*n),this.base.style.width=`${t}px`,this.base.style.height=`${e}px`,this.base.getContext("2d").setTransform(n,0,0,n,0,0),this.overlay.resize(t,e),this.fitted&&this.reset()}reset(){const t=[this.high[0]-this.low[0],this.high[1]-this.low[1]],e=this.width<600?6:18,n=this.scene?.frame==="image"?e:34;this.scale=Math.max(1e-6,Math.min((this.width-2*e)/t[0],(this.height-e-n)/t[1]));const s=(this.width-this.scale*t[0])/2,r=n+(this.height-n-e-this.scale*t[1])/2;this.origin=[s-this.scale*this.low[0],this.upwards?r+this.scale*this.high[1]:r-this.scale*this.low[1]],this.fitted=!0,this.redraw()}draw(t,e){const n=this.base.getContext("2d");n.clearRect(0,0,this.width,this.height),this.scene?.frame==="image"?this.draw_picture(n):this.draw_ground(n),this.overlay.clear(),e&&(this.state.trail_s>0&&this.draw_trails(this.overlay.draw,t,e),this.scene?.frame==="image"?this.draw_boxes(e):this.draw_people(e))}get upwards(){return this.scene?.frame==="ground"&&!this.scene.y_down}x(t){return this.origin[0]+this.scale*t}y(t){return this.origin[1]+(this.upwards?-1:1)*this.scale*t}wheel(t){t.preventDefault(),this.zoom(Math.exp(-.0015*t.deltaY*(t.deltaMode===1?20:1)),t.offsetX,t.offsetY)}zoom(t,e,n){const s=Math.max(.2,Math.min(5,t));this.scale*=s,this.origin=[e-s*(e-this.origin[0]),n-s*(n-this.origin[1])],this.fitted=!1,this.redraw()}drag(t){const e=this.fingers.get(t.pointerId);if(!e||t.pointerType==="mouse"&&t.buttons===0)return;const n=[...this.fingers].find(([r])=>r!==t.pointerId)?.[1],s=[t.offsetX,t.offsetY];if(n){const r=a=>Math.hypot(a[0]-n[0],a[1]-n[1]);this.zoom(r(s)/Math.max(1,r(e)),(s[0]+n[0])/2,(s[1]+n[1])/2)}else this.origin=[this.origin[0]+s[0]-e[0],this.origin[1]+s[1]-e[1]],this.fitted=!1,this.redraw();this.fingers.set(t.pointerId,s)}draw_picture(t){const[e,n]=[this.x(this.low[0]),this.y(this.low[1])],[s,r]=[this.scale*(this.high[0]-this.low[0]),this.scale*(this.high[1]-this.low[1])];t.fillStyle=this.state.dark?"#171c22":"#e6e9ed",t.fillRect(e,n,s,r),this.video_image&&t.drawImage(this.video_image.image,e,n,s,r)}draw_ground(t){const e=this.scene?.pitch;if(!e)return this.draw_grid(t);const n=this.state.dark,{x:s,y:r,length:a,width:o}=e,l=(v,m,p,S)=>[this.x(v),this.upwards?this.y(m+S):this.y(m),this.scale*p,this.scale*S];t.fillStyle=n?"#15291c":"#cfe3cf",t.fillRect(...l(s-4,r-4,a+8,o+8)),t.fillStyle=n?"#193021":"#d8ead8";const c=a/20;for(let v=0;v<20;v+=2)t.fillRect(...l(s+v*c,r,c,o));t.strokeStyle=n?"rgba(214,232,218,.55)":"rgba(60,100,70,.6)",t.fillStyle=t.strokeStyle,t.lineWidth=Math.max(1,.12*this.scale),t.strokeRect(...l(s,r,a,o));const h=s+a/2,u=r+o/2,f=(v,m,p,S,C)=>{t.beginPath(),t.arc(this.x(v),this.y(m),p*this.scale,S,C),t.stroke()},d=v=>{t.beginPath(),t.arc(this.x(v),this.y(u),Math.max(1.5,.2*this.scale),0,7),t.fill()};t.beginPath(),t.moveTo(this.x(h),this.y(r)),t.lineTo(this.x(h),this.y(r+o)),t.stroke(),f(h,u,9.15,0,7),d(h);const x=Math.acos(5.5/9.15);for(const v of[0,1]){const m=s+v*a,p=v?-1:1;for(const[S,C]of[[16.5,40.32],[5.5,18.32]])t.strokeRect(...l(v?m-S:m,u-C/2,S,C));t.strokeRect(...l(v?m:m-2,u-3.66,2,7.32)),d(m+p*11),f(m+p*11,u,9.15,v?Math.PI-x:-x,v?Math.PI+x:x)}}draw_grid(t){const e=[.5,1,2,5,10,20,50,100].find(a=>a*this.scale>34)??200;t.strokeStyle=this.state.dark?"#222933":"#dde1e6",t.fillStyle=this.state.dark?"#5f6b78":"#8a949f",t.font=`10px ${pa}`,t.lineWidth=1,t.beginPath();const n=[];for(let a=Math.ceil(-this.origin[0]/this.scale/e)*e;this.x(a)<this.width;a+=e)t.moveTo(this.x(a),0),t.lineTo(this.x(a),this.height),n.push([`${a} m`,this.x(a)+3,this.height-5]);const s=this.upwards?-1:1,r=[(0-this.origin[1])/(s*this.scale),(this.height-this.origin[1])/(s*this.scale)];for(let a=Math.ceil(Math.min(...r)/e)*e;a<Math.max(...r);a+=e)t.moveTo(0,this.y(a)),t.lineTo(this.width,this.y(a)),n.push([`${a} m`,4,this.y(a)-3]);t.stroke();for(const[a,o,l]of n)t.fillText(a,o,l)}dimmed(t){return this.state.selected.size>0&&!this.state.selected.has(t)&&this.state.hover!==t}draw_trails(t,e,n){const s=Ji(n),r=new Map,a=this.scene?.frame==="image";t.lineCap="round",t.lineWidth=a?2:Math.max(1.5,.28*this.scale);for(const{chunk:o,k:l}of md(e,n,this.state.trail_s,$m)){const c=o.time[l],h=.7*(1-(s-c)/this.state.trail_s);for(let u=o.begin(l);u<o.row_end[l];++u){const f=o.track[u];if(this.state.hidden.has(f)||this.dimmed(f))continue;const d=a&&o.box&&o.has_box(u)?o.box:null,x=this.x(d?d[0][u]+d[2][u]/2:o.x[u]),v=this.y(d?d[1][u]+d[3][u]:o.y[u]),m=r.get(f);m&&m[2]-c<1&&(t.strokeStyle=this.colours.css(f,h),t.beginPath(),t.moveTo(x,v),t.lineTo(m[0],m[1]),t.stroke()),r.set(f,[x,v,c])}}}draw_people(t){const{chunk:e,k:n}=t,s=this.overlay.draw,r=Math.max(7.5,Math.min(15,1.25*this.scale)),a=[];s.textAlign="center",s.textBaseline="middle";for(let o=e.begin(n);o<e.row_end[n];++o){const l=e.track[o];if(this.state.hidden.has(l))continue;const[c,h]=[this.x(e.x[o]),this.y(e.y[o])],u=e.provenance(o)===0,f=this.state.selected.has(l)||this.state.hover===l,d=wr(this.tracks.get(l),l),x=d.length<=3&&r>=7;s.globalAlpha=this.dimmed(l)?.35:1,s.beginPath(),s.arc(c,h,r,0,7),s.fillStyle=u?this.colours.css(l):this.state.dark?"#15291c":"#d8ead8",s.fill(),s.lineWidth=f?3:1.5,s.strokeStyle=f?this.state.dark?"#fff":"#111":u?"rgba(10,14,18,.55)":this.colours.css(l),s.stroke(),x&&(s.font=`600 ${Math.round(Math.min(11,r))}px ${pa}`,s.fillStyle=u&&this.colours.is_light(l)?"#10151a":"#fff",!u&&!this.state.dark&&(s.fillStyle="#222"),s.fillText(d,c,h+.5)),s.globalAlpha=1,a.push({id:l,x:c,y:h,radius:r,text:x?"":d,depth:o})}s.textAlign="left",this.overlay.labels(a,this.state.labels)}draw_boxes(t){const{chunk:e,k:n}=t,s=this.overlay.draw,r=[];for(let a=e.begin(n);a<e.row_end[n];++a){const o=e.track[a];if(this.state.hidden.has(o))continue;const l=this.state.selected.has(o)||this.state.hover===o,c=e.provenance(a)===0,h=this.dimmed(o)?.35:1,u=wr(this.tracks.get(o),o);if(Em(s,e,a,this.scene?.bones??[],(m,p)=>[this.x(m),this.y(p)],m=>this.colours.css(o,m),h,l?3.5:2),s.strokeStyle=this.colours.css(o,h),!e.box||!e.has_box(a)){const[m,p]=[this.x(e.x[a]),this.y(e.y[a])];s.lineWidth=l?3:1.75,s.beginPath(),s.arc(m,p,5,0,7),s.stroke(),r.push({id:o,x:m,y:p,radius:5,text:u,depth:a});continue}const[f,d]=[this.x(e.box[0][a]-.5),this.y(e.box[1][a]-.5)],[x,v]=[this.scale*e.box[2][a],this.scale*e.box[3][a]];s.lineWidth=l?3.5:2,s.setLineDash(c?[]:[5,4]),s.beginPath(),s.roundRect(f,d,x,v,3),s.stroke(),s.setLineDash([]),(this.state.labels||l)&&this.name_box(u,o,f,d,h),r.push({id:o,x:f+x/2,y:d+v/2,radius:Math.min(x,v)/2,text:"",depth:a})}this.overlay.labels(r,this.state.labels)}name_box(t,e,n,s,r){const a=this.overlay.draw;a.font=`600 11px ${pa}`,a.textBaseline="middle";const o=a.measureText(t).width+8,l=Math.max(1,s-16);a.globalAlpha=r,a.fillStyle=this.colours.css(e),a.beginPath(),a.roundRect(n-1,l,o,15,3),a.fill(),a.fillStyle=this.colours.is_light(e)?"#10151a":"#fff",a.fillText(t,n+3,l+8),a.globalAlpha=1}}const Ym=!0,_n="u-",qm="uplot",Km=_n+"hz",Zm=_n+"vt",Jm=_n+"title",Qm=_n+"wrap",jm=_n+"under",tg=_n+"over",eg=_n+"axis",Fs=_n+"off",ng=_n+"select",ig=_n+"cursor-x",sg=_n+"cursor-y",rg=_n+"cursor-pt",ag=_n+"legend",og=_n+"live",lg=_n+"inline",cg=_n+"series",hg=_n+"marker",du=_n+"label",ug=_n+"value",ca="width",ha="height",Jr="top",pu="bottom",er="left",fl="right",th="#000",mu=th+"0",dl="mousemove",gu="mousedown",pl="mouseup",_u="mouseenter",xu="mouseleave",vu="dblclick",fg="resize",dg="scroll",Mu="change",Ao="dppxchange",eh="--",Ir=typeof window<"u",tc=Ir?document:null,Sr=Ir?window:null,pg=Ir?navigator:null;let ye,Fa;function ec(){let i=devicePixelRatio;ye!=i&&(ye=i,Fa&&ic(Mu,Fa,ec),Fa=matchMedia(`(min-resolution: ${ye-.001}dppx) and (max-resolution: ${ye+.001}dppx)`),Os(Mu,Fa,ec),Sr.dispatchEvent(new CustomEvent(Ao)))}function Qn(i,t){if(t!=null){let e=i.classList;!e.contains(t)&&e.add(t)}}function nc(i,t){let e=i.classList;e.contains(t)&&e.remove(t)}function He(i,t,e){i.style[t]=e+"px"}function mi(i,t,e,n){let s=tc.createElement(i);return t!=null&&Qn(s,t),e?.insertBefore(s,n),s}function ri(i,t){return mi("div",i,t)}const Su=new WeakMap;function Ci(i,t,e,n,s){let r="translate("+t+"px,"+e+"px)",a=Su.get(i);r!=a&&(i.style.transform=r,Su.set(i,r),t<0||e<0||t>n||e>s?Qn(i,Fs):nc(i,Fs))}const yu=new WeakMap;function Eu(i,t,e){let n=t+e,s=yu.get(i);n!=s&&(yu.set(i,n),i.style.background=t,i.style.borderColor=e)}const bu=new WeakMap;function wu(i,t,e,n){let s=t+""+e,r=bu.get(i);s!=r&&(bu.set(i,s),i.style.height=e+"px",i.style.width=t+"px",i.style.marginLeft=n?-t/2+"px":0,i.style.marginTop=n?-e/2+"px":0)}const nh={passive:!0},mg={...nh,capture:!0};function Os(i,t,e,n){t.addEventListener(i,e,n?mg:nh)}function ic(i,t,e,n){t.removeEventListener(i,e,nh)}Ir&&ec();function gi(i,t,e,n){let s;e=e||0,n=n||t.length-1;let r=n<=2147483647;for(;n-e>1;)s=r?e+n>>1:ti((e+n)/2),t[s]<i?e=s:n=s;return i-t[e]<=t[n]-i?e:n}function gd(i){return(e,n,s)=>{let r=-1,a=-1;for(let o=n;o<=s;o++)if(i(e[o])){r=o;break}for(let o=s;o>=n;o--)if(i(e[o])){a=o;break}return[r,a]}}const _d=i=>i!=null,xd=i=>i!=null&&i>0,Bo=gd(_d),gg=gd(xd);function _g(i,t,e,n=0,s=!1){let r=s?gg:Bo,a=s?xd:_d;[t,e]=r(i,t,e);let o=i[t],l=i[t];if(t>-1)if(n==1)o=i[t],l=i[e];else if(n==-1)o=i[e],l=i[t];else for(let c=t;c<=e;c++){let h=i[c];a(h)&&(h<o?o=h:h>l&&(l=h))}return[o??Ie,l??-Ie]}function zo(i,t,e,n){let s=Ru(i),r=Ru(t);i==t&&(s==-1?(i*=e,t/=e):(i/=e,t*=e));let a=e==10?ts:vd,o=s==1?ti:ai,l=r==1?ai:ti,c=o(a(pn(i))),h=l(a(pn(t))),u=Tr(e,c),f=Tr(e,h);return e==10&&(c<0&&(u=Ue(u,-c)),h<0&&(f=Ue(f,-h))),n||e==2?(i=u*s,t=f*r):(i=Ed(i,u),t=Ho(t,f)),[i,t]}function ih(i,t,e,n){let s=zo(i,t,e,n);return i==0&&(s[0]=0),t==0&&(s[1]=0),s}const sh=.1,Tu={mode:3,pad:sh},ma={pad:0,soft:null,mode:0},xg={min:ma,max:ma};function Ro(i,t,e,n){return Go(e)?Au(i,t,e):(ma.pad=e,ma.soft=n?0:null,ma.mode=n?3:0,Au(i,t,xg))}function Me(i,t){return i??t}function vg(i,t,e){for(t=Me(t,0),e=Me(e,i.length-1);t<=e;){if(i[t]!=null)return!0;t++}return!1}function Au(i,t,e){let n=e.min,s=e.max,r=Me(n.pad,0),a=Me(s.pad,0),o=Me(n.hard,-Ie),l=Me(s.hard,Ie),c=Me(n.soft,Ie),h=Me(s.soft,-Ie),u=Me(n.mode,0),f=Me(s.mode,0),d=t-i,x=ts(d),v=Bn(pn(i),pn(t)),m=ts(v),p=pn(m-x);(d<1e-24||p>10)&&(d=0,(i==0||t==0)&&(d=1e-24,u==2&&c!=Ie&&(r=0),f==2&&h!=-Ie&&(a=0)));let S=d||v||1e3,C=ts(S),b=Tr(10,ti(C)),P=S*(d==0?i==0?.1:1:r),T=Ue(Ed(i-P,b/10),24),_=i>=c&&(u==1||u==3&&T<=c||u==2&&T>=c)?c:Ie,w=Bn(o,T<_&&i>=_?_:xi(_,T)),B=S*(d==0?t==0?.1:1:a),I=Ue(Ho(t+B,b/10),24),D=t<=h&&(f==1||f==3&&I>=h||f==2&&I<=h)?h:-Ie,z=xi(l,I>D&&t<=D?D:Bn(D,I));return w==z&&w==0&&(z=100),[w,z]}const Mg=new Intl.NumberFormat(Ir?pg.language:"en-US"),rh=i=>Mg.format(i),ei=Math,_o=ei.PI,pn=ei.abs,ti=ei.floor,dn=ei.round,ai=ei.ceil,xi=ei.min,Bn=ei.max,Tr=ei.pow,Ru=ei.sign,ts=ei.log10,vd=ei.log2,Sg=(i,t=1)=>ei.sinh(i)*t,ml=(i,t=1)=>ei.asinh(i/t),Ie=1/0;function Cu(i){return(ts((i^i>>31)-(i>>31))|0)+1}function sc(i,t,e){return xi(Bn(i,t),e)}function Md(i){return typeof i=="function"}function pe(i){return Md(i)?i:()=>i}const yg=()=>{},Sd=i=>i,yd=(i,t)=>t,Eg=i=>null,Pu=i=>!0,Lu=(i,t)=>i==t,bg=/\.\d*?(?=9{6,}|0{6,})/gm,ks=i=>{if(wd(i)||Es.has(i))return i;const t=`${i}`,e=t.match(bg);if(e==null)return i;let n=e[0].length-1;if(t.indexOf("e-")!=-1){let[s,r]=t.split("e");return+`${ks(s)}e${r}`}return Ue(i,n)};function Is(i,t){return ks(Ue(ks(i/t))*t)}function Ho(i,t){return ks(ai(ks(i/t))*t)}function Ed(i,t){return ks(ti(ks(i/t))*t)}function Ue(i,t=0){if(wd(i))return i;let e=10**t,n=i*e*(1+Number.EPSILON);return dn(n)/e}const Es=new Map;function bd(i){return((""+i).split(".")[1]||"").length}function Ma(i,t,e,n){let s=[],r=n.map(bd);for(let a=t;a<e;a++){let o=pn(a),l=Ue(Tr(i,a),o);for(let c=0;c<n.length;c++){let h=i==10?+`${n[c]}e${a}`:n[c]*l,u=(a>=0?0:o)+(a>=r[c]?0:r[c]),f=i==10?h:Ue(h,u);s.push(f),Es.set(f,u)}}return s}const ga={},ah=[],Ar=[null,null],xs=Array.isArray,wd=Number.isInteger,wg=i=>i===void 0;function Du(i){return typeof i=="string"}function Go(i){let t=!1;if(i!=null){let e=i.constructor;t=e==null||e==Object}return t}function Tg(i){return i!=null&&typeof i=="object"}const Ag=Object.getPrototypeOf(Uint8Array),Td="__proto__";function Rr(i,t=Go){let e;if(xs(i)){let n=i.find(s=>s!=null);if(xs(n)||t(n)){e=Array(i.length);for(let s=0;s<i.length;s++)e[s]=Rr(i[s],t)}else e=i.slice()}else if(i instanceof Ag)e=i.slice();else if(t(i)){e={};for(let n in i)n!=Td&&(e[n]=Rr(i[n],t))}else e=i;return e}function cn(i){let t=arguments;for(let e=1;e<t.length;e++){let n=t[e];for(let s in n)s!=Td&&(Go(i[s])?cn(i[s],Rr(n[s])):i[s]=Rr(n[s]))}return i}const Rg=0,Cg=1,Pg=2;function Lg(i,t,e){for(let n=0,s,r=-1;n<t.length;n++){let a=t[n];if(a>r){for(s=a-1;s>=0&&i[s]==null;)i[s--]=null;for(s=a+1;s<e&&i[s]==null;)i[r=s++]=null}}}function Dg(i,t){if(Ug(i)){let a=i[0].slice();for(let o=1;o<i.length;o++)a.push(...i[o].slice(1));return Fg(a[0])||(a=Ig(a)),a}let e=new Set;for(let a=0;a<i.length;a++){let l=i[a][0],c=l.length;for(let h=0;h<c;h++)e.add(l[h])}let n=[Array.from(e).sort((a,o)=>a-o)],s=n[0].length,r=new Map;for(let a=0;a<s;a++)r.set(n[0][a],a);for(let a=0;a<i.length;a++){let o=i[a],l=o[0];for(let c=1;c<o.length;c++){let h=o[c],u=Array(s).fill(void 0),f=t?t[a][c]:Cg,d=[];for(let x=0;x<h.length;x++){let v=h[x],m=r.get(l[x]);v===null?f!=Rg&&(u[m]=v,f==Pg&&d.push(m)):u[m]=v}Lg(u,d,s),n.push(u)}}return n}const Ng=typeof queueMicrotask>"u"?i=>Promise.resolve().then(i):queueMicrotask;function Ig(i){let t=i[0],e=t.length,n=Array(e);for(let r=0;r<n.length;r++)n[r]=r;n.sort((r,a)=>t[r]-t[a]);let s=[];for(let r=0;r<i.length;r++){let a=i[r],o=Array(e);for(let l=0;l<e;l++)o[l]=a[n[l]];s.push(o)}return s}function Ug(i){let t=i[0][0],e=t.length;for(let n=1;n<i.length;n++){let s=i[n][0];if(s.length!=e)return!1;if(s!=t){for(let r=0;r<e;r++)if(s[r]!=t[r])return!1}}return!0}function Fg(i,t=100){const e=i.length;if(e<=1)return!0;let n=0,s=e-1;for(;n<=s&&i[n]==null;)n++;for(;s>=n&&i[s]==null;)s--;if(s<=n)return!0;const r=Bn(1,ti((s-n+1)/t));for(let a=i[n],o=n+r;o<=s;o+=r){const l=i[o];if(l!=null){if(l<=a)return!1;a=l}}return!0}const Ad=["January","February","March","April","May","June","July","August","September","October","November","December"],Rd=["Sunday","Monday","Tuesday","Wednesday","Thursday","Friday","Saturday"];function Cd(i){return i.slice(0,3)}const Og=Rd.map(Cd),kg=Ad.map(Cd),Bg={MMMM:Ad,MMM:kg,WWWW:Rd,WWW:Og};function Qr(i){return(i<10?"0":"")+i}function zg(i){return(i<10?"00":i<100?"0":"")+i}const Hg={YYYY:i=>i.getFullYear(),YY:i=>(i.getFullYear()+"").slice(2),MMMM:(i,t)=>t.MMMM[i.getMonth()],MMM:(i,t)=>t.MMM[i.getMonth()],MM:i=>Qr(i.getMonth()+1),M:i=>i.getMonth()+1,DD:i=>Qr(i.getDate()),D:i=>i.getDate(),WWWW:(i,t)=>t.WWWW[i.getDay()],WWW:(i,t)=>t.WWW[i.getDay()],HH:i=>Qr(i.getHours()),H:i=>i.getHours(),h:i=>{let t=i.getHours();return t==0?12:t>12?t-12:t},AA:i=>i.getHours()>=12?"PM":"AM",aa:i=>i.getHours()>=12?"pm":"am",a:i=>i.getHours()>=12?"p":"a",mm:i=>Qr(i.getMinutes()),m:i=>i.getMinutes(),ss:i=>Qr(i.getSeconds()),s:i=>i.getSeconds(),fff:i=>zg(i.getMilliseconds())};function oh(i,t){t=t||Bg;let e=[],n=/\{([a-z]+)\}|[^{]+/gi,s;for(;s=n.exec(i);)e.push(s[0][0]=="{"?Hg[s[1]]:s[0]);return r=>{let a="";for(let o=0;o<e.length;o++)a+=typeof e[o]=="string"?e[o]:e[o](r,t);return a}}const Gg=new Intl.DateTimeFormat().resolvedOptions().timeZone;function Vg(i,t){let e;return t=="UTC"||t=="Etc/UTC"?e=new Date(+i+i.getTimezoneOffset()*6e4):t==Gg?e=i:(e=new Date(i.toLocaleString("en-US",{timeZone:t})),e.setMilliseconds(i.getMilliseconds())),e}const Pd=i=>i%1==0,Co=[1,2,2.5,5],Wg=Ma(10,-32,0,Co),Ld=Ma(10,0,32,Co),Xg=Ld.filter(Pd),Us=Wg.concat(Ld),lh=`
`,Dd="{YYYY}",Nu=lh+Dd,Nd="{M}/{D}",ua=lh+Nd,Oa=ua+"/{YY}",Id="{aa}",$g="{h}:{mm}",mr=$g+Id,Iu=lh+mr,Uu=":{ss}",we=null;function Ud(i){let t=i*1e3,e=t*60,n=e*60,s=n*24,r=s*30,a=s*365,l=(i==1?Ma(10,0,3,Co).filter(Pd):Ma(10,-3,0,Co)).concat([t,t*5,t*10,t*15,t*30,e,e*5,e*10,e*15,e*30,n,n*2,n*3,n*4,n*6,n*8,n*12,s,s*2,s*3,s*4,s*5,s*6,s*7,s*8,s*9,s*10,s*15,r,r*2,r*3,r*4,r*6,a,a*2,a*5,a*10,a*25,a*50,a*100]);const c=[[a,Dd,we,we,we,we,we,we,1],[s*28,"{MMM}",Nu,we,we,we,we,we,1],[s,Nd,Nu,we,we,we,we,we,1],[n,"{h}"+Id,Oa,we,ua,we,we,we,1],[e,mr,Oa,we,ua,we,we,we,1],[t,Uu,Oa+" "+mr,we,ua+" "+mr,we,Iu,we,1],[i,Uu+".{fff}",Oa+" "+mr,we,ua+" "+mr,we,Iu,we,1]];function h(u){return(f,d,x,v,m,p)=>{let S=[],C=m>=a,b=m>=r&&m<a,P=u(x),T=Ue(P*i,3),_=gl(P.getFullYear(),C?0:P.getMonth(),b||C?1:P.getDate()),w=Ue(_*i,3);if(b||C){let B=b?m/r:0,I=C?m/a:0,D=T==w?T:Ue(gl(_.getFullYear()+I,_.getMonth()+B,1)*i,3),z=new Date(dn(D/i)),V=z.getFullYear(),N=z.getMonth();for(let H=0;D<=v;H++){let K=gl(V+I*H,N+B*H,1),k=K-u(Ue(K*i,3));D=Ue((+K+k)*i,3),D<=v&&S.push(D)}}else{let B=m>=s?s:m,I=ti(x)-ti(T),D=w+I+Ho(T-w,B);S.push(D);let z=u(D),V=z.getHours()+z.getMinutes()/e+z.getSeconds()/n,N=m/n,H=f.axes[d]._space,K=p/H;for(;D=Ue(D+m,i==1?0:3),!(D>v);)if(N>1){let k=ti(Ue(V+N,6))%24,Q=u(D).getHours()-k;Q>1&&(Q=-1),D-=Q*n,V=(V+N)%24;let it=S[S.length-1];Ue((D-it)/m,3)*K>=.7&&S.push(D)}else S.push(D)}return S}}return[l,c,h]}const[Yg,qg,Kg]=Ud(1),[Zg,Jg,Qg]=Ud(.001);Ma(2,-53,53,[1]);function Fu(i,t){return i.map(e=>e.map((n,s)=>s==0||s==8||n==null?n:t(s==1||e[8]==0?n:e[1]+n)))}function Ou(i,t){return(e,n,s,r,a)=>{let o=t.find(x=>a>=x[0])||t[t.length-1],l,c,h,u,f,d;return n.map(x=>{let v=i(x),m=v.getFullYear(),p=v.getMonth(),S=v.getDate(),C=v.getHours(),b=v.getMinutes(),P=v.getSeconds(),T=m!=l&&o[2]||p!=c&&o[3]||S!=h&&o[4]||C!=u&&o[5]||b!=f&&o[6]||P!=d&&o[7]||o[1];return l=m,c=p,h=S,u=C,f=b,d=P,T(v)})}}function jg(i,t){let e=oh(t);return(n,s,r,a,o)=>s.map(l=>e(i(l)))}function gl(i,t,e){return new Date(i,t,e)}function ku(i,t){return t(i)}const t_="{YYYY}-{MM}-{DD} {h}:{mm}{aa}";function Bu(i,t){return(e,n,s,r)=>r==null?eh:t(i(n))}function e_(i,t){let e=i.series[t];return e.width?e.stroke(i,t):e.points.width?e.points.stroke(i,t):null}function n_(i,t){return i.series[t].fill(i,t)}const i_={show:!0,live:!0,isolate:!1,mount:yg,markers:{show:!0,width:2,stroke:e_,fill:n_,dash:"solid"},idx:null,idxs:null,values:[]};function s_(i,t){let e=i.cursor.points,n=ri(),s=e.size(i,t);He(n,ca,s),He(n,ha,s);let r=s/-2;He(n,"marginLeft",r),He(n,"marginTop",r);let a=e.width(i,t,s);return a&&He(n,"borderWidth",a),n}function r_(i,t){let e=i.series[t].points;return e._fill||e._stroke}function a_(i,t){let e=i.series[t].points;return e._stroke||e._fill}function o_(i,t){return i.series[t].points.size}const _l=[0,0];function l_(i,t,e){return _l[0]=t,_l[1]=e,_l}function ka(i,t,e,n=!0){return s=>{s.button==0&&(!n||s.target==t)&&e(s)}}function xl(i,t,e,n=!0){return s=>{(!n||s.target==t)&&e(s)}}const c_={show:!0,x:!0,y:!0,lock:!1,move:l_,points:{one:!1,show:s_,size:o_,width:0,stroke:a_,fill:r_},bind:{mousedown:ka,mouseup:ka,click:ka,dblclick:ka,mousemove:xl,mouseleave:xl,mouseenter:xl},drag:{setScale:!0,x:!0,y:!1,dist:0,uni:null,click:(i,t)=>{t.stopPropagation(),t.stopImmediatePropagation()},_x:!1,_y:!1},focus:{dist:(i,t,e,n,s)=>n-s,prox:-1,bias:0},hover:{skip:[void 0],prox:null,bias:0},left:-10,top:-10,idx:null,dataIdx:null,idxs:null,event:null},Fd={show:!0,stroke:"rgba(0,0,0,0.07)",width:2},ch=cn({},Fd,{filter:yd}),Od=cn({},ch,{size:10}),kd=cn({},Fd,{show:!1}),hh='12px system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, "Noto Sans", sans-serif, "Apple Color Emoji", "Segoe UI Emoji", "Segoe UI Symbol", "Noto Color Emoji"',Bd="bold "+hh,zd=1.5,zu={show:!0,scale:"x",stroke:th,space:50,gap:5,alignTo:1,size:50,labelGap:0,labelSize:30,labelFont:Bd,side:2,grid:ch,ticks:Od,border:kd,font:hh,lineGap:zd,rotate:0},h_="Value",u_="Time",Hu={show:!0,scale:"x",auto:!1,sorted:1,min:Ie,max:-Ie,idxs:[]};function f_(i,t,e,n,s){return t.map(r=>r==null?"":rh(r))}function d_(i,t,e,n,s,r,a){let o=[],l=Es.get(s)||0;e=a?e:Ue(Ho(e,s),l);for(let c=e;c<=n;c=Ue(c+s,l))o.push(Object.is(c,-0)?0:c);return o}function rc(i,t,e,n,s,r,a){const o=[],l=i.scales[i.axes[t].scale].log,c=l==10?ts:vd,h=ti(c(e));s=Tr(l,h),l==10&&(s=Us[gi(s,Us)]);let u=e,f=s*l;l==10&&(f=Us[gi(f,Us)]);do o.push(u),u=u+s,l==10&&!Es.has(u)&&(u=Ue(u,Es.get(s))),u>=f&&(s=u,f=s*l,l==10&&(f=Us[gi(f,Us)]));while(u<=n);return o}function p_(i,t,e,n,s,r,a){let l=i.scales[i.axes[t].scale].asinh,c=n>l?rc(i,t,Bn(l,e),n,s):[l],h=n>=0&&e<=0?[0]:[];return(e<-l?rc(i,t,Bn(l,-n),-e,s):[l]).reverse().map(f=>-f).concat(h,c)}const Hd=/./,m_=/[12357]/,g_=/[125]/,Gu=/1/,ac=(i,t,e,n)=>i.map((s,r)=>t==4&&s==0||r%n==0&&e.test(s.toExponential()[s<0?1:0])?s:null);function __(i,t,e,n,s){let r=i.axes[e],a=r.scale,o=i.scales[a],l=i.valToPos,c=r._space,h=l(10,a),u=l(9,a)-h>=c?Hd:l(7,a)-h>=c?m_:l(5,a)-h>=c?g_:Gu;if(u==Gu){let f=pn(l(1,a)-h);if(f<c)return ac(t.slice().reverse(),o.distr,u,ai(c/f)).reverse()}return ac(t,o.distr,u,1)}function x_(i,t,e,n,s){let r=i.axes[e],a=r.scale,o=r._space,l=i.valToPos,c=pn(l(1,a)-l(2,a));return c<o?ac(t.slice().reverse(),3,Hd,ai(o/c)).reverse():t}function v_(i,t,e,n){return n==null?eh:t==null?"":rh(t)}const Vu={show:!0,scale:"y",stroke:th,space:30,gap:5,alignTo:1,size:50,labelGap:0,labelSize:30,labelFont:Bd,side:3,grid:ch,ticks:Od,border:kd,font:hh,lineGap:zd,rotate:0};function M_(i,t){let e=3+(i||1)*2;return Ue(e*t,3)}function S_(i,t){let{scale:e,idxs:n}=i.series[0],s=i._data[0],r=i.valToPos(s[n[0]],e,!0),a=i.valToPos(s[n[1]],e,!0),o=pn(a-r),l=i.series[t],c=o/(l.points.space*ye);return n[1]-n[0]<=c}const Wu={scale:null,auto:!0,sorted:0,min:Ie,max:-Ie},Gd=(i,t,e,n,s)=>s,Xu={show:!0,auto:!0,sorted:0,gaps:Gd,alpha:1,facets:[cn({},Wu,{scale:"x"}),cn({},Wu,{scale:"y"})]},$u={scale:"y",auto:!0,sorted:0,show:!0,spanGaps:!1,gaps:Gd,alpha:1,points:{show:S_,filter:null},values:null,min:Ie,max:-Ie,idxs:[],path:null,clip:null};function y_(i,t,e,n,s){return e/10}const Vd={time:Ym,auto:!0,distr:1,log:10,asinh:1,min:null,max:null,dir:1,ori:0},E_=cn({},Vd,{time:!1,ori:1}),Yu={};function Wd(i,t){let e=Yu[i];return e||(e={key:i,plots:[],sub(n){e.plots.push(n)},unsub(n){e.plots=e.plots.filter(s=>s!=n)},pub(n,s,r,a,o,l,c){for(let h=0;h<e.plots.length;h++)e.plots[h]!=s&&e.plots[h].pub(n,s,r,a,o,l,c)}},i!=null&&(Yu[i]=e)),e}const Cr=1,oc=2;function Gs(i,t,e){const n=i.mode,s=i.series[t],r=n==2?i._data[t]:i._data,a=i.scales,o=i.bbox;let l=r[0],c=n==2?r[1]:r[t],h=n==2?a[s.facets[0].scale]:a[i.series[0].scale],u=n==2?a[s.facets[1].scale]:a[s.scale],f=o.left,d=o.top,x=o.width,v=o.height,m=i.valToPosH,p=i.valToPosV;return h.ori==0?e(s,l,c,h,u,m,p,f,d,x,v,Wo,Ur,$o,$d,qd):e(s,l,c,h,u,p,m,d,f,v,x,Xo,Fr,dh,Yd,Kd)}function uh(i,t){let e=0,n=0,s=Me(i.bands,ah);for(let r=0;r<s.length;r++){let a=s[r];a.series[0]==t?e=a.dir:a.series[1]==t&&(a.dir==1?n|=1:n|=2)}return[e,n==1?-1:n==2?1:n==3?2:0]}function b_(i,t,e,n,s){let r=i.mode,a=i.series[t],o=r==2?a.facets[1].scale:a.scale,l=i.scales[o];return s==-1?l.min:s==1?l.max:l.distr==3?l.dir==1?l.min:l.max:0}function es(i,t,e,n,s,r){return Gs(i,t,(a,o,l,c,h,u,f,d,x,v,m)=>{let p=a.pxRound;const S=c.dir*(c.ori==0?1:-1),C=c.ori==0?Ur:Fr;let b,P;S==1?(b=e,P=n):(b=n,P=e);let T=p(u(o[b],c,v,d)),_=p(f(l[b],h,m,x)),w=p(u(o[P],c,v,d)),B=p(f(r==1?h.max:h.min,h,m,x)),I=new Path2D(s);return C(I,w,B),C(I,T,B),C(I,T,_),I})}function Vo(i,t,e,n,s,r){let a=null;if(i.length>0){a=new Path2D;const o=t==0?$o:dh;let l=e;for(let u=0;u<i.length;u++){let f=i[u];if(f[1]>f[0]){let d=f[0]-l;d>0&&o(a,l,n,d,n+r),l=f[1]}}let c=e+s-l,h=10;c>0&&o(a,l,n-h/2,c,n+r+h)}return a}function w_(i,t,e){let n=i[i.length-1];n&&n[0]==t?n[1]=e:i.push([t,e])}function fh(i,t,e,n,s,r,a){let o=[],l=i.length;for(let c=s==1?e:n;c>=e&&c<=n;c+=s)if(t[c]===null){let u=c,f=c;if(s==1)for(;++c<=n&&t[c]===null;)f=c;else for(;--c>=e&&t[c]===null;)f=c;let d=r(i[u]),x=f==u?d:r(i[f]),v=u-s;d=a<=0&&v>=0&&v<l?r(i[v]):d;let p=f+s;x=a>=0&&p>=0&&p<l?r(i[p]):x,x>=d&&o.push([d,x])}return o}function qu(i){return i==0?Sd:i==1?dn:t=>Is(t,i)}function Xd(i){let t=i==0?Wo:Xo,e=i==0?(s,r,a,o,l,c)=>{s.arcTo(r,a,o,l,c)}:(s,r,a,o,l,c)=>{s.arcTo(a,r,l,o,c)},n=i==0?(s,r,a,o,l)=>{s.rect(r,a,o,l)}:(s,r,a,o,l)=>{s.rect(a,r,l,o)};return(s,r,a,o,l,c=0,h=0)=>{c==0&&h==0?n(s,r,a,o,l):(c=xi(c,o/2,l/2),h=xi(h,o/2,l/2),t(s,r+c,a),e(s,r+o,a,r+o,a+l,c),e(s,r+o,a+l,r,a+l,h),e(s,r,a+l,r,a,h),e(s,r,a,r+o,a,c),s.closePath())}}const Wo=(i,t,e)=>{i.moveTo(t,e)},Xo=(i,t,e)=>{i.moveTo(e,t)},Ur=(i,t,e)=>{i.lineTo(t,e)},Fr=(i,t,e)=>{i.lineTo(e,t)},$o=Xd(0),dh=Xd(1),$d=(i,t,e,n,s,r)=>{i.arc(t,e,n,s,r)},Yd=(i,t,e,n,s,r)=>{i.arc(e,t,n,s,r)},qd=(i,t,e,n,s,r,a)=>{i.bezierCurveTo(t,e,n,s,r,a)},Kd=(i,t,e,n,s,r,a)=>{i.bezierCurveTo(e,t,s,n,a,r)};function Zd(i){return(t,e,n,s,r)=>Gs(t,e,(a,o,l,c,h,u,f,d,x,v,m)=>{let{pxRound:p,points:S}=a,C,b;c.ori==0?(C=Wo,b=$d):(C=Xo,b=Yd);const P=Ue(S.width*ye,3);let T=(S.size-S.width)/2*ye,_=Ue(T*2,3),w=new Path2D,B=new Path2D,{left:I,top:D,width:z,height:V}=t.bbox;$o(B,I-_,D-_,z+_*2,V+_*2);const N=H=>{if(l[H]!=null){let K=p(u(o[H],c,v,d)),k=p(f(l[H],h,m,x));C(w,K+T,k),b(w,K,k,T,0,_o*2)}};if(r)r.forEach(N);else for(let H=n;H<=s;H++)N(H);return{stroke:P>0?w:null,fill:w,clip:B,flags:Cr|oc}})}function Jd(i){return(t,e,n,s,r,a)=>{n!=s&&(r!=n&&a!=n&&i(t,e,n),r!=s&&a!=s&&i(t,e,s),i(t,e,a))}}const T_=Jd(Ur),A_=Jd(Fr);function Qd(i){const t=Me(i?.alignGaps,0);return(e,n,s,r)=>Gs(e,n,(a,o,l,c,h,u,f,d,x,v,m)=>{[s,r]=Bo(l,s,r);let p=a.pxRound,S=V=>p(u(V,c,v,d)),C=V=>p(f(V,h,m,x)),b,P;c.ori==0?(b=Ur,P=T_):(b=Fr,P=A_);const T=c.dir*(c.ori==0?1:-1),_={stroke:new Path2D,fill:null,clip:null,band:null,gaps:null,flags:Cr},w=_.stroke;let B=!1;if(r-s>=v*4){let V=ht=>e.posToVal(ht,c.key,!0),N=null,H=null,K,k,lt,Z=S(o[T==1?s:r]),Q=S(o[s]),it=S(o[r]),ut=V(T==1?Q+1:it-1);for(let ht=T==1?s:r;ht>=s&&ht<=r;ht+=T){let j=o[ht],_t=(T==1?j<ut:j>ut)?Z:S(j),Tt=l[ht];_t==Z?Tt!=null?(k=Tt,N==null?(b(w,_t,C(k)),K=N=H=k):k<N?N=k:k>H&&(H=k)):Tt===null&&(B=!0):(N!=null&&P(w,Z,C(N),C(H),C(K),C(k)),Tt!=null?(k=Tt,b(w,_t,C(k)),N=H=K=k):(N=H=null,Tt===null&&(B=!0)),Z=_t,ut=V(Z+T))}N!=null&&N!=H&&lt!=Z&&P(w,Z,C(N),C(H),C(K),C(k))}else for(let V=T==1?s:r;V>=s&&V<=r;V+=T){let N=l[V];N===null?B=!0:N!=null&&b(w,S(o[V]),C(N))}let[D,z]=uh(e,n);if(a.fill!=null||D!=0){let V=_.fill=new Path2D(w),N=a.fillTo(e,n,a.min,a.max,D),H=C(N),K=S(o[s]),k=S(o[r]);T==-1&&([k,K]=[K,k]),b(V,k,H),b(V,K,H)}if(!a.spanGaps){let V=[];B&&V.push(...fh(o,l,s,r,T,S,t)),_.gaps=V=a.gaps(e,n,s,r,V),_.clip=Vo(V,c.ori,d,x,v,m)}return z!=0&&(_.band=z==2?[es(e,n,s,r,w,-1),es(e,n,s,r,w,1)]:es(e,n,s,r,w,z)),_})}function R_(i){const t=Me(i.align,1),e=Me(i.ascDesc,!1),n=Me(i.alignGaps,0),s=Me(i.extend,!1);return(r,a,o,l)=>Gs(r,a,(c,h,u,f,d,x,v,m,p,S,C)=>{[o,l]=Bo(u,o,l);let b=c.pxRound,{left:P,width:T}=r.bbox,_=Q=>b(x(Q,f,S,m)),w=Q=>b(v(Q,d,C,p)),B=f.ori==0?Ur:Fr;const I={stroke:new Path2D,fill:null,clip:null,band:null,gaps:null,flags:Cr},D=I.stroke,z=f.dir*(f.ori==0?1:-1);let V=w(u[z==1?o:l]),N=_(h[z==1?o:l]),H=N,K=N;s&&t==-1&&(K=P,B(D,K,V)),B(D,N,V);for(let Q=z==1?o:l;Q>=o&&Q<=l;Q+=z){let it=u[Q];if(it==null)continue;let ut=_(h[Q]),ht=w(it);t==1?B(D,ut,V):B(D,H,ht),B(D,ut,ht),V=ht,H=ut}let k=H;s&&t==1&&(k=P+T,B(D,k,V));let[lt,Z]=uh(r,a);if(c.fill!=null||lt!=0){let Q=I.fill=new Path2D(D),it=c.fillTo(r,a,c.min,c.max,lt),ut=w(it);B(Q,k,ut),B(Q,K,ut)}if(!c.spanGaps){let Q=[];Q.push(...fh(h,u,o,l,z,_,n));let it=c.width*ye/2,ut=e||t==1?it:-it,ht=e||t==-1?-it:it;Q.forEach(j=>{j[0]+=ut,j[1]+=ht}),I.gaps=Q=c.gaps(r,a,o,l,Q),I.clip=Vo(Q,f.ori,m,p,S,C)}return Z!=0&&(I.band=Z==2?[es(r,a,o,l,D,-1),es(r,a,o,l,D,1)]:es(r,a,o,l,D,Z)),I})}function Ku(i,t,e,n,s,r,a=Ie){if(i.length>1){let o=null;for(let l=0,c=1/0;l<i.length;l++)if(t[l]!==void 0){if(o!=null){let h=pn(i[l]-i[o]);h<c&&(c=h,a=pn(e(i[l],n,s,r)-e(i[o],n,s,r)))}o=l}}return a}function C_(i){i=i||ga;const t=Me(i.size,[.6,Ie,1]),e=i.align||0,n=i.gap||0;let s=i.radius;s=s==null?[0,0]:typeof s=="number"?[s,0]:s;const r=pe(s),a=1-t[0],o=Me(t[1],Ie),l=Me(t[2],1),c=Me(i.disp,ga),h=Me(i.each,d=>{}),{fill:u,stroke:f}=c;return(d,x,v,m)=>Gs(d,x,(p,S,C,b,P,T,_,w,B,I,D)=>{let z=p.pxRound,V=e,N=n*ye,H=o*ye,K=l*ye,k,lt;b.ori==0?[k,lt]=r(d,x):[lt,k]=r(d,x);const Z=b.dir*(b.ori==0?1:-1);let Q=b.ori==0?$o:dh,it=b.ori==0?h:(Rt,Xt,te,yt,Ne,Bt,Wt)=>{h(Rt,Xt,te,Ne,yt,Wt,Bt)},ut=Me(d.bands,ah).find(Rt=>Rt.series[0]==x),ht=ut!=null?ut.dir:0,j=p.fillTo(d,x,p.min,p.max,ht),pt=z(_(j,P,D,B)),_t,Tt,St,Gt=I,jt=z(p.width*ye),zt=!1,le=null,re=null,Jt=null,Ge=null;u!=null&&(jt==0||f!=null)&&(zt=!0,le=u.values(d,x,v,m),re=new Map,new Set(le).forEach(Rt=>{Rt!=null&&re.set(Rt,new Path2D)}),jt>0&&(Jt=f.values(d,x,v,m),Ge=new Map,new Set(Jt).forEach(Rt=>{Rt!=null&&Ge.set(Rt,new Path2D)})));let{x0:Fe,size:tn}=c;if(Fe!=null&&tn!=null){V=1,S=Fe.values(d,x,v,m),Fe.unit==2&&(S=S.map(te=>d.posToVal(w+te*I,b.key,!0)));let Rt=tn.values(d,x,v,m);tn.unit==2?Tt=Rt[0]*I:Tt=T(Rt[0],b,I,w)-T(0,b,I,w),Gt=Ku(S,C,T,b,I,w,Gt),St=Gt-Tt+N}else Gt=Ku(S,C,T,b,I,w,Gt),St=Gt*a+N,Tt=Gt-St;St<1&&(St=0),jt>=Tt/2&&(jt=0),St<5&&(z=Sd);let Le=St>0,xn=Gt-St-(Le?jt:0);Tt=z(sc(xn,K,H)),_t=(V==0?Tt/2:V==Z?0:Tt)-V*Z*((V==0?N/2:0)+(Le?jt/2:0));const xe={stroke:null,fill:null,clip:null,band:null,gaps:null,flags:0},hn=zt?null:new Path2D;let Xe=null;if(ut!=null)Xe=d.data[ut.series[1]];else{let{y0:Rt,y1:Xt}=c;Rt!=null&&Xt!=null&&(C=Xt.values(d,x,v,m),Xe=Rt.values(d,x,v,m))}let en=k*Tt,F=lt*Tt;for(let Rt=Z==1?v:m;Rt>=v&&Rt<=m;Rt+=Z){let Xt=C[Rt];if(Xt==null)continue;if(Xe!=null){let X=Xe[Rt]??0;if(Xt-X==0)continue;pt=_(X,P,D,B)}let te=b.distr!=2||c!=null?S[Rt]:Rt,yt=T(te,b,I,w),Ne=_(Me(Xt,j),P,D,B),Bt=z(yt-_t),Wt=z(Bn(Ne,pt)),A=z(xi(Ne,pt)),M=Wt-A;if(Xt!=null){let X=Xt<0?F:en,ct=Xt<0?en:F;zt?(jt>0&&Jt[Rt]!=null&&Q(Ge.get(Jt[Rt]),Bt,A+ti(jt/2),Tt,Bn(0,M-jt),X,ct),le[Rt]!=null&&Q(re.get(le[Rt]),Bt,A+ti(jt/2),Tt,Bn(0,M-jt),X,ct)):Q(hn,Bt,A+ti(jt/2),Tt,Bn(0,M-jt),X,ct),it(d,x,Rt,Bt-jt/2,A,Tt+jt,M)}}return jt>0?xe.stroke=zt?Ge:hn:zt||(xe._fill=p.width==0?p._fill:p._stroke??p._fill,xe.width=0),xe.fill=zt?re:hn,xe})}function P_(i,t){const e=Me(t?.alignGaps,0);return(n,s,r,a)=>Gs(n,s,(o,l,c,h,u,f,d,x,v,m,p)=>{[r,a]=Bo(c,r,a);let S=o.pxRound,C=k=>S(f(k,h,m,x)),b=k=>S(d(k,u,p,v)),P,T,_;h.ori==0?(P=Wo,_=Ur,T=qd):(P=Xo,_=Fr,T=Kd);const w=h.dir*(h.ori==0?1:-1);let B=C(l[w==1?r:a]),I=B,D=[],z=[];for(let k=w==1?r:a;k>=r&&k<=a;k+=w)if(c[k]!=null){let Z=l[k],Q=C(Z);D.push(I=Q),z.push(b(c[k]))}const V={stroke:i(D,z,P,_,T,S),fill:null,clip:null,band:null,gaps:null,flags:Cr},N=V.stroke;let[H,K]=uh(n,s);if(o.fill!=null||H!=0){let k=V.fill=new Path2D(N),lt=o.fillTo(n,s,o.min,o.max,H),Z=b(lt);_(k,I,Z),_(k,B,Z)}if(!o.spanGaps){let k=[];k.push(...fh(l,c,r,a,w,C,e)),V.gaps=k=o.gaps(n,s,r,a,k),V.clip=Vo(k,h.ori,x,v,m,p)}return K!=0&&(V.band=K==2?[es(n,s,r,a,N,-1),es(n,s,r,a,N,1)]:es(n,s,r,a,N,K)),V})}function L_(i){return P_(D_,i)}function D_(i,t,e,n,s,r){const a=i.length;if(a<2)return null;const o=new Path2D;if(e(o,i[0],t[0]),a==2)n(o,i[1],t[1]);else{let l=Array(a),c=Array(a-1),h=Array(a-1),u=Array(a-1);for(let f=0;f<a-1;f++)h[f]=t[f+1]-t[f],u[f]=i[f+1]-i[f],c[f]=h[f]/u[f];l[0]=c[0];for(let f=1;f<a-1;f++)c[f]===0||c[f-1]===0||c[f-1]>0!=c[f]>0?l[f]=0:(l[f]=3*(u[f-1]+u[f])/((2*u[f]+u[f-1])/c[f-1]+(u[f]+2*u[f-1])/c[f]),isFinite(l[f])||(l[f]=0));l[a-1]=c[a-2];for(let f=0;f<a-1;f++)s(o,i[f]+u[f]/3,t[f]+l[f]*u[f]/3,i[f+1]-u[f]/3,t[f+1]-l[f+1]*u[f]/3,i[f+1],t[f+1])}return o}const lc=new Set;function Zu(){for(let i of lc)i.syncRect(!0)}Ir&&(Os(fg,Sr,Zu),Os(dg,Sr,Zu,!0),Os(Ao,Sr,()=>{Rn.pxRatio=ye}));const N_=Qd(),I_=Zd();function Ju(i,t,e,n){return(n?[i[0],i[1]].concat(i.slice(2)):[i[0]].concat(i.slice(1))).map((r,a)=>cc(r,a,t,e))}function U_(i,t){return i.map((e,n)=>n==0?{}:cn({},t,e))}function cc(i,t,e,n){return cn({},t==0?e:n,i)}function jd(i,t,e){return t==null?Ar:[t,e]}const F_=jd;function O_(i,t,e){return t==null?Ar:Ro(t,e,sh,!0)}function tp(i,t,e,n){return t==null?Ar:zo(t,e,i.scales[n].log,!1)}const k_=tp;function ep(i,t,e,n){return t==null?Ar:ih(t,e,i.scales[n].log,!1)}const B_=ep;function z_(i,t,e,n,s){let r=Bn(Cu(i),Cu(t)),a=t-i,o=gi(s/n*a,e);do{let l=e[o],c=n*l/a;if(c>=s&&r+(l<5?Es.get(l):0)<=17)return[l,c]}while(++o<e.length);return[0,0]}function Qu(i){let t,e;return i=i.replace(/(\d+)px/,(n,s)=>(t=dn((e=+s)*ye))+"px"),[i,t,e]}function H_(i){i.show&&[i.font,i.labelFont].forEach(t=>{let e=Ue(t[2]*ye,1);t[0]=t[0].replace(/[0-9.]+px/,e+"px"),t[1]=e})}function Rn(i,t,e){const n={mode:Me(i.mode,1)},s=n.mode;function r(g,y,R,L){let G=y.valToPct(g);return L+R*(y.dir==-1?1-G:G)}function a(g,y,R,L){let G=y.valToPct(g);return L+R*(y.dir==-1?G:1-G)}function o(g,y,R,L){return y.ori==0?r(g,y,R,L):a(g,y,R,L)}n.valToPosH=r,n.valToPosV=a;let l=!1;n.status=0;const c=n.root=ri(qm);if(i.id!=null&&(c.id=i.id),Qn(c,i.class),i.title){let g=ri(Jm,c);g.textContent=i.title}const h=mi("canvas"),u=n.ctx=h.getContext("2d"),f=ri(Qm,c);Os("click",f,g=>{g.target===x&&(ke!=Zs||Ve!=Js)&&Tn.click(n,g)},!0);const d=n.under=ri(jm,f);f.appendChild(h);const x=n.over=ri(tg,f);i=Rr(i);const v=+Me(i.pxAlign,1),m=qu(v);(i.plugins||[]).forEach(g=>{g.opts&&(i=g.opts(n,i)||i)});const p=i.ms||.001,S=n.series=s==1?Ju(i.series||[],Hu,$u,!1):U_(i.series||[null],Xu),C=n.axes=Ju(i.axes||[],zu,Vu,!0),b=n.scales={},P=n.bands=i.bands||[];P.forEach(g=>{g.fill=pe(g.fill||null),g.dir=Me(g.dir,-1)});const T=s==2?S[1].facets[0].scale:S[0].scale,_={axes:Gi,series:he},w=(i.drawOrder||["axes","series"]).map(g=>_[g]);function B(g){const y=g.distr==3?R=>ts(R>0?R:g.clamp(n,R,g.min,g.max,g.key)):g.distr==4?R=>ml(R,g.asinh):g.distr==100?R=>g.fwd(R):R=>R;return R=>{let L=y(R),{_min:G,_max:q}=g,at=q-G;return(L-G)/at}}function I(g){let y=b[g];if(y==null){let R=(i.scales||ga)[g]||ga;if(R.from!=null){I(R.from);let L=cn({},b[R.from],R,{key:g});L.valToPct=B(L),b[g]=L}else{y=b[g]=cn({},g==T?Vd:E_,R),y.key=g;let L=y.time,G=y.range,q=xs(G);if((g!=T||s==2&&!L)&&(q&&(G[0]==null||G[1]==null)&&(G={min:G[0]==null?Tu:{mode:1,hard:G[0],soft:G[0]},max:G[1]==null?Tu:{mode:1,hard:G[1],soft:G[1]}},q=!1),!q&&Go(G))){let at=G;G=(ft,vt,Dt)=>vt==null?Ar:Ro(vt,Dt,at)}y.range=pe(G||(L?F_:g==T?y.distr==3?k_:y.distr==4?B_:jd:y.distr==3?tp:y.distr==4?ep:O_)),y.auto=pe(q?!1:y.auto),y.clamp=pe(y.clamp||y_),y._min=y._max=null,y.valToPct=B(y)}}}I("x"),I("y"),s==1&&S.forEach(g=>{I(g.scale)}),C.forEach(g=>{I(g.scale)});for(let g in i.scales)I(g);const D=b[T],z=D.distr;let V,N;D.ori==0?(Qn(c,Km),V=r,N=a):(Qn(c,Zm),V=a,N=r);const H={};for(let g in b){let y=b[g];(y.min!=null||y.max!=null)&&(H[g]={min:y.min,max:y.max},y.min=y.max=null)}const K=i.tzDate||(g=>new Date(dn(g/p))),k=i.fmtDate||oh,lt=p==1?Kg(K):Qg(K),Z=Ou(K,Fu(p==1?qg:Jg,k)),Q=Bu(K,ku(t_,k)),it=[],ut=n.legend=cn({},i_,i.legend),ht=n.cursor=cn({},c_,{drag:{y:s==2}},i.cursor),j=ut.show,pt=ht.show,_t=ut.markers;ut.idxs=it,_t.width=pe(_t.width),_t.dash=pe(_t.dash),_t.stroke=pe(_t.stroke),_t.fill=pe(_t.fill);let Tt,St,Gt,jt=[],zt=[],le,re=!1,Jt={};if(ut.live){const g=S[1]?S[1].values:null;re=g!=null,le=re?g(n,1,0):{_:0};for(let y in le)Jt[y]=eh}if(j)if(Tt=mi("table",ag,c),Gt=mi("tbody",null,Tt),ut.mount(n,Tt),re){St=mi("thead",null,Tt,Gt);let g=mi("tr",null,St);mi("th",null,g);for(var Ge in le)mi("th",du,g).textContent=Ge}else Qn(Tt,lg),ut.live&&Qn(Tt,og);const Fe={show:!0},tn={show:!1};function Le(g,y){if(y==0&&(re||!ut.live||s==2))return Ar;let R=[],L=mi("tr",cg,Gt,Gt.childNodes[y]);Qn(L,g.class),g.show||Qn(L,Fs);let G=mi("th",null,L);if(_t.show){let ft=ri(hg,G);if(y>0){let vt=_t.width(n,y);vt&&(ft.style.border=vt+"px "+_t.dash(n,y)+" "+_t.stroke(n,y)),ft.style.background=_t.fill(n,y)}}let q=ri(du,G);g.label instanceof HTMLElement?q.appendChild(g.label):q.textContent=g.label,y>0&&(_t.show||(q.style.color=g.width>0?_t.stroke(n,y):_t.fill(n,y)),xe("click",G,ft=>{if(ht._lock)return;Yt(ft);let vt=S.indexOf(g);if((ft.ctrlKey||ft.metaKey)!=ut.isolate){let Dt=S.some((Nt,Ut)=>Ut>0&&Ut!=vt&&Nt.show);S.forEach((Nt,Ut)=>{Ut>0&&wi(Ut,Dt?Ut==vt?Fe:tn:Fe,!0,an.setSeries)})}else wi(vt,{show:!g.show},!0,an.setSeries)},!1),qt&&xe(_u,G,ft=>{ht._lock||(Yt(ft),wi(S.indexOf(g),js,!0,an.setSeries))},!1));for(var at in le){let ft=mi("td",ug,L);ft.textContent="--",R.push(ft)}return[L,R]}const xn=new Map;function xe(g,y,R,L=!0){const G=xn.get(y)||{},q=ht.bind[g](n,y,R,L);q&&(Os(g,y,G[g]=q),xn.set(y,G))}function hn(g,y,R){const L=xn.get(y)||{};for(let G in L)(g==null||G==g)&&(ic(G,y,L[G]),delete L[G]);g==null&&xn.delete(y)}let Xe=0,en=0,F=0,Rt=0,Xt=0,te=0,yt=Xt,Ne=te,Bt=F,Wt=Rt,A=0,M=0,X=0,ct=0;n.bbox={};let rt=!1,gt=!1,xt=!1,tt=!1,nt=!1,dt=!1;function U(g,y,R){(R||g!=n.width||y!=n.height)&&st(g,y),ae(!1),xt=!0,gt=!0,Cn()}function st(g,y){n.width=Xe=F=g,n.height=en=Rt=y,Xt=te=0,Mt(),Ht();let R=n.bbox;A=R.left=Is(Xt*ye,.5),M=R.top=Is(te*ye,.5),X=R.width=Is(F*ye,.5),ct=R.height=Is(Rt*ye,.5)}const et=3;function Et(){let g=!1,y=0;for(;!g;){y++;let R=Ys(y),L=bi(y);g=y==et||R&&L,g||(st(n.width,n.height),gt=!0)}}function mt({width:g,height:y}){U(g,y)}n.setSize=mt;function Mt(){let g=!1,y=!1,R=!1,L=!1;C.forEach((G,q)=>{if(G.show&&G._show){let{side:at,_size:ft}=G,vt=at%2,Dt=G.label!=null?G.labelSize:0,Nt=ft+Dt;Nt>0&&(vt?(F-=Nt,at==3?(Xt+=Nt,L=!0):R=!0):(Rt-=Nt,at==0?(te+=Nt,g=!0):y=!0))}}),yi[0]=g,yi[1]=R,yi[2]=y,yi[3]=L,F-=ci[1]+ci[3],Xt+=ci[3],Rt-=ci[2]+ci[0],te+=ci[0]}function Ht(){let g=Xt+F,y=te+Rt,R=Xt,L=te;function G(q,at){switch(q){case 1:return g+=at,g-at;case 2:return y+=at,y-at;case 3:return R-=at,R+at;case 0:return L-=at,L+at}}C.forEach((q,at)=>{if(q.show&&q._show){let ft=q.side;q._pos=G(ft,q._size),q.label!=null&&(q._lpos=G(ft,q.labelSize))}})}if(ht.dataIdx==null){let g=ht.hover,y=g.skip=new Set(g.skip??[]);y.add(void 0);let R=g.prox=pe(g.prox),L=g.bias??=0;ht.dataIdx=(G,q,at,ft)=>{if(q==0)return at;let vt=at,Dt=R(G,q,at,ft)??Ie,Nt=Dt>=0&&Dt<Ie,Ut=D.ori==0?F:Rt,Qt=ht.left,Se=t[0],ve=t[q];if(y.has(ve[at])){vt=null;let ue=null,$t=null,Vt;if(L==0||L==-1)for(Vt=at;ue==null&&Vt-- >0;)y.has(ve[Vt])||(ue=Vt);if(L==0||L==1)for(Vt=at;$t==null&&Vt++<ve.length;)y.has(ve[Vt])||($t=Vt);if(ue!=null||$t!=null)if(Nt){let ze=ue==null?-1/0:V(Se[ue],D,Ut,0),qe=$t==null?1/0:V(Se[$t],D,Ut,0),yn=Qt-ze,De=qe-Qt;yn<=De?yn<=Dt&&(vt=ue):De<=Dt&&(vt=$t)}else vt=$t==null?ue:ue==null?$t:at-ue<=$t-at?ue:$t}else Nt&&pn(Qt-V(Se[at],D,Ut,0))>Dt&&(vt=null);return vt}}const Yt=g=>{ht.event=g};ht.idxs=it,ht._lock=!1;let ot=ht.points;ot.show=pe(ot.show),ot.size=pe(ot.size),ot.stroke=pe(ot.stroke),ot.width=pe(ot.width),ot.fill=pe(ot.fill);const Ft=n.focus=cn({},i.focus||{alpha:.3},ht.focus),qt=Ft.prox>=0,At=qt&&ot.one;let ie=[],Oe=[],Dn=[];function zr(g,y){let R=ot.show(n,y);if(R instanceof HTMLElement)return Qn(R,rg),Qn(R,g.class),Ci(R,-10,-10,F,Rt),x.insertBefore(R,ie[y]),R}function Ws(g,y){if(s==1||y>0){let R=s==1&&b[g.scale].time,L=g.value;g.value=R?Du(L)?Bu(K,ku(L,k)):L||Q:L||v_,g.label=g.label||(R?u_:h_)}if(At||y>0){g.width=g.width==null?1:g.width,g.paths=g.paths||N_||Eg,g.fillTo=pe(g.fillTo||b_),g.pxAlign=+Me(g.pxAlign,v),g.pxRound=qu(g.pxAlign),g.stroke=pe(g.stroke||null),g.fill=pe(g.fill||null),g._stroke=g._fill=g._paths=g._focus=null;let R=M_(Bn(1,g.width),1),L=g.points=cn({},{size:R,width:Bn(1,R*.2),stroke:g.stroke,space:R*2,paths:I_,_stroke:null,_fill:null},g.points);L.show=pe(L.show),L.filter=pe(L.filter),L.fill=pe(L.fill),L.stroke=pe(L.stroke),L.paths=pe(L.paths),L.pxAlign=g.pxAlign}if(j){let R=Le(g,y);jt.splice(y,0,R[0]),zt.splice(y,0,R[1]),ut.values.push(null)}if(pt){it.splice(y,0,null);let R=null;At?y==0&&(R=zr(g,y)):y>0&&(R=zr(g,y)),ie.splice(y,0,R),Oe.splice(y,0,0),Dn.splice(y,0,0)}Sn("addSeries",y)}function Zo(g,y){y=y??S.length,g=s==1?cc(g,y,Hu,$u):cc(g,y,{},Xu),S.splice(y,0,g),Ws(S[y],y)}n.addSeries=Zo;function Ca(g){if(S.splice(g,1),j){ut.values.splice(g,1),zt.splice(g,1);let y=jt.splice(g,1)[0];hn(null,y.firstChild),y.remove()}pt&&(it.splice(g,1),ie.splice(g,1)[0].remove(),Oe.splice(g,1),Dn.splice(g,1)),Sn("delSeries",g)}n.delSeries=Ca;const yi=[!1,!1,!1,!1];function Bi(g,y){if(g._show=g.show,g.show){let R=g.side%2,L=b[g.scale];L==null&&(g.scale=R?S[1].scale:T,L=b[g.scale]);let G=L.time;g.size=pe(g.size),g.space=pe(g.space),g.rotate=pe(g.rotate),xs(g.incrs)&&g.incrs.forEach(at=>{!Es.has(at)&&Es.set(at,bd(at))}),g.incrs=pe(g.incrs||(L.distr==2?Xg:G?p==1?Yg:Zg:Us)),g.splits=pe(g.splits||(G&&L.distr==1?lt:L.distr==3?rc:L.distr==4?p_:d_)),g.stroke=pe(g.stroke),g.grid.stroke=pe(g.grid.stroke),g.ticks.stroke=pe(g.ticks.stroke),g.border.stroke=pe(g.border.stroke);let q=g.values;g.values=xs(q)&&!xs(q[0])?pe(q):G?xs(q)?Ou(K,Fu(q,k)):Du(q)?jg(K,q):q||Z:q||f_,g.filter=pe(g.filter||(L.distr>=3&&L.log==10?__:L.distr==3&&L.log==2?x_:yd)),g.font=Qu(g.font),g.labelFont=Qu(g.labelFont),g._size=g.size(n,null,y,0),g._space=g._rotate=g._incrs=g._found=g._splits=g._values=null,g._size>0&&(yi[y]=!0,g._el=ri(eg,f))}}function zi(g,y,R,L){let[G,q,at,ft]=R,vt=y%2,Dt=0;return vt==0&&(ft||q)&&(Dt=y==0&&!G||y==2&&!at?dn(zu.size/3):0),vt==1&&(G||at)&&(Dt=y==1&&!q||y==3&&!ft?dn(Vu.size/2):0),Dt}const Hr=n.padding=(i.padding||[zi,zi,zi,zi]).map(g=>pe(Me(g,zi))),ci=n._padding=Hr.map((g,y)=>g(n,y,yi,0));let $e,Je=null,Qe=null;const Ei=s==1?S[0].idxs:null;let Wn=null,rs=!1;function Gr(g,y){if(t=g??[],n.data=n._data=t,s==2){$e=0;for(let R=1;R<S.length;R++)$e+=t[R][0].length}else{t.length==0&&(n.data=n._data=t=[[]]),Wn=t[0],$e=Wn.length;let R=t;if(z==2){R=t.slice();let L=R[0]=Array($e);for(let G=0;G<$e;G++)L[G]=G}n._data=t=R}if(ae(!0),Sn("setData"),z==2&&(xt=!0),y!==!1){let R=D;R.auto(n,rs)?Vr():ls(T,R.min,R.max),tt=tt||ht.left>=0,dt=!0,Cn()}}n.setData=Gr;function Vr(){rs=!0;let g,y;s==1&&($e>0?(Je=Ei[0]=0,Qe=Ei[1]=$e-1,g=t[0][Je],y=t[0][Qe],z==2?(g=Je,y=Qe):g==y&&(z==3?[g,y]=zo(g,g,D.log,!1):z==4?[g,y]=ih(g,g,D.log,!1):D.time?y=g+dn(86400/p):[g,y]=Ro(g,y,sh,!0))):(Je=Ei[0]=g=null,Qe=Ei[1]=y=null)),ls(T,g,y)}let Xs,as,$s,E,O,J,$,Y,bt,Ct;function wt(g,y,R,L,G,q){g??=mu,R??=ah,L??="butt",G??=mu,q??="round",g!=Xs&&(u.strokeStyle=Xs=g),G!=as&&(u.fillStyle=as=G),y!=$s&&(u.lineWidth=$s=y),q!=O&&(u.lineJoin=O=q),L!=J&&(u.lineCap=J=L),R!=E&&u.setLineDash(E=R)}function Pt(g,y,R,L){y!=as&&(u.fillStyle=as=y),g!=$&&(u.font=$=g),R!=Y&&(u.textAlign=Y=R),L!=bt&&(u.textBaseline=bt=L)}function kt(g,y,R,L,G=0){if(L.length>0&&g.auto(n,rs)&&(y==null||y.min==null)){let q=Me(Je,0),at=Me(Qe,L.length-1),ft=R.min==null?_g(L,q,at,G,g.distr==3):[R.min,R.max];g.min=xi(g.min,R.min=ft[0]),g.max=Bn(g.max,R.max=ft[1])}}const Zt={min:null,max:null};function ce(){for(let L in b){let G=b[L];H[L]==null&&(G.min==null||H[T]!=null&&G.auto(n,rs))&&(H[L]=Zt)}for(let L in b){let G=b[L];H[L]==null&&G.from!=null&&H[G.from]!=null&&(H[L]=Zt)}H[T]!=null&&ae(!0);let g={};for(let L in H){let G=H[L];if(G!=null){let q=g[L]=Rr(b[L],Tg);if(G.min!=null)cn(q,G);else if(L!=T||s==2)if($e==0&&q.from==null){let at=q.range(n,null,null,L);q.min=at[0],q.max=at[1]}else q.min=Ie,q.max=-Ie}}if($e>0){S.forEach((L,G)=>{if(s==1){let q=L.scale,at=H[q];if(at==null)return;let ft=g[q];if(G==0){let vt=ft.range(n,ft.min,ft.max,q);ft.min=vt[0],ft.max=vt[1],Je=gi(ft.min,t[0]),Qe=gi(ft.max,t[0]),Qe-Je>1&&(t[0][Je]<ft.min&&Je++,t[0][Qe]>ft.max&&Qe--),L.min=Wn[Je],L.max=Wn[Qe]}else L.show&&L.auto&&kt(ft,at,L,t[G],L.sorted);L.idxs[0]=Je,L.idxs[1]=Qe}else if(G>0&&L.show&&L.auto){let[q,at]=L.facets,ft=q.scale,vt=at.scale,[Dt,Nt]=t[G],Ut=g[ft],Qt=g[vt];Ut!=null&&kt(Ut,H[ft],q,Dt,q.sorted),Qt!=null&&kt(Qt,H[vt],at,Nt,at.sorted),L.min=at.min,L.max=at.max}});for(let L in g){let G=g[L],q=H[L];if(G.from==null&&(q==null||q.min==null)){let at=G.range(n,G.min==Ie?null:G.min,G.max==-Ie?null:G.max,L);G.min=at[0],G.max=at[1]}}}for(let L in g){let G=g[L];if(G.from!=null){let q=g[G.from];if(q.min==null)G.min=G.max=null;else{let at=G.range(n,q.min,q.max,L);G.min=at[0],G.max=at[1]}}}let y={},R=!1;for(let L in g){let G=g[L],q=b[L];if(q.min!=G.min||q.max!=G.max){q.min=G.min,q.max=G.max;let at=q.distr;q._min=at==3?ts(q.min):at==4?ml(q.min,q.asinh):at==100?q.fwd(q.min):q.min,q._max=at==3?ts(q.max):at==4?ml(q.max,q.asinh):at==100?q.fwd(q.max):q.max,y[L]=R=!0}}if(R){S.forEach((L,G)=>{s==2?G>0&&y.y&&(L._paths=null):y[L.scale]&&(L._paths=null)});for(let L in y)xt=!0,Sn("setScale",L);pt&&ht.left>=0&&(tt=dt=!0)}for(let L in H)H[L]=null}function Ot(g){let y=sc(Je-1,0,$e-1),R=sc(Qe+1,0,$e-1);for(;g[y]==null&&y>0;)y--;for(;g[R]==null&&R<$e-1;)R++;return[y,R]}function he(){if($e>0){let g=S.some(y=>y._focus)&&Ct!=Ft.alpha;g&&(u.globalAlpha=Ct=Ft.alpha),S.forEach((y,R)=>{if(R>0&&y.show&&(We(R,!1),We(R,!0),y._paths==null)){let L=Ct;Ct!=y.alpha&&(u.globalAlpha=Ct=y.alpha);let G=s==2?[0,t[R][0].length-1]:Ot(t[R]);y._paths=y.paths(n,R,G[0],G[1]),Ct!=L&&(u.globalAlpha=Ct=L)}}),S.forEach((y,R)=>{if(R>0&&y.show){let L=Ct;Ct!=y.alpha&&(u.globalAlpha=Ct=y.alpha),y._paths!=null&&Te(R,!1);{let G=y._paths!=null?y._paths.gaps:null,q=y.points.show(n,R,Je,Qe,G),at=y.points.filter(n,R,q,G);(q||at)&&(y.points._paths=y.points.paths(n,R,Je,Qe,at),Te(R,!0))}Ct!=L&&(u.globalAlpha=Ct=L),Sn("drawSeries",R)}}),g&&(u.globalAlpha=Ct=1)}}function We(g,y){let R=y?S[g].points:S[g];R._stroke=R.stroke(n,g),R._fill=R.fill(n,g)}function Te(g,y){let R=y?S[g].points:S[g],{stroke:L,fill:G,clip:q,flags:at,_stroke:ft=R._stroke,_fill:vt=R._fill,_width:Dt=R.width}=R._paths;Dt=Ue(Dt*ye,3);let Nt=null,Ut=Dt%2/2;y&&vt==null&&(vt=Dt>0?"#fff":ft);let Qt=R.pxAlign==1&&Ut>0;if(Qt&&u.translate(Ut,Ut),!y){let Se=A-Dt/2,ve=M-Dt/2,ue=X+Dt,$t=ct+Dt;Nt=new Path2D,Nt.rect(Se,ve,ue,$t)}y?It(ft,Dt,R.dash,R.cap,vt,L,G,at,q):Ae(g,ft,Dt,R.dash,R.cap,vt,L,G,at,Nt,q),Qt&&u.translate(-Ut,-Ut)}function Ae(g,y,R,L,G,q,at,ft,vt,Dt,Nt){let Ut=!1;vt!=0&&P.forEach((Qt,Se)=>{if(Qt.series[0]==g){let ve=S[Qt.series[1]],ue=t[Qt.series[1]],$t=(ve._paths||ga).band;xs($t)&&($t=Qt.dir==1?$t[0]:$t[1]);let Vt,ze=null;ve.show&&$t&&vg(ue,Je,Qe)?(ze=Qt.fill(n,Se)||q,Vt=ve._paths.clip):$t=null,It(y,R,L,G,ze,at,ft,vt,Dt,Nt,Vt,$t),Ut=!0}}),Ut||It(y,R,L,G,q,at,ft,vt,Dt,Nt)}const un=Cr|oc;function It(g,y,R,L,G,q,at,ft,vt,Dt,Nt,Ut){wt(g,y,R,L,G),(vt||Dt||Ut)&&(u.save(),vt&&u.clip(vt),Dt&&u.clip(Dt)),Ut?(ft&un)==un?(u.clip(Ut),Nt&&u.clip(Nt),de(G,at),nn(g,q,y)):ft&oc?(de(G,at),u.clip(Ut),nn(g,q,y)):ft&Cr&&(u.save(),u.clip(Ut),Nt&&u.clip(Nt),de(G,at),u.restore(),nn(g,q,y)):(de(G,at),nn(g,q,y)),(vt||Dt||Ut)&&u.restore()}function nn(g,y,R){R>0&&(y instanceof Map?y.forEach((L,G)=>{u.strokeStyle=Xs=G,u.stroke(L)}):y!=null&&g&&u.stroke(y))}function de(g,y){y instanceof Map?y.forEach((R,L)=>{u.fillStyle=as=L,u.fill(R)}):y!=null&&g&&u.fill(y)}function Hi(g,y,R,L){let G=C[g],q;if(L<=0)q=[0,0];else{let at=G._space=G.space(n,g,y,R,L),ft=G._incrs=G.incrs(n,g,y,R,L,at);q=z_(y,R,ft,L,at)}return G._found=q}function sn(g,y,R,L,G,q,at,ft,vt,Dt){let Nt=at%2/2;v==1&&u.translate(Nt,Nt),wt(ft,at,vt,Dt,ft),u.beginPath();let Ut,Qt,Se,ve,ue=G+(L==0||L==3?-q:q);R==0?(Qt=G,ve=ue):(Ut=G,Se=ue);for(let $t=0;$t<g.length;$t++)y[$t]!=null&&(R==0?Ut=Se=g[$t]:Qt=ve=g[$t],u.moveTo(Ut,Qt),u.lineTo(Se,ve));u.stroke(),v==1&&u.translate(-Nt,-Nt)}function Ys(g){let y=!0;return C.forEach((R,L)=>{if(!R.show)return;let G=b[R.scale];if(G.min==null){R._show&&(y=!1,R._show=!1,ae(!1));return}else R._show||(y=!1,R._show=!0,ae(!1));let q=R.side,at=q%2,{min:ft,max:vt}=G,[Dt,Nt]=Hi(L,ft,vt,at==0?F:Rt);if(Nt==0)return;let Ut=G.distr==2,Qt=R._splits=R.splits(n,L,ft,vt,Dt,Nt,Ut),Se=G.distr==2?Qt.map(Vt=>Wn[Vt]):Qt,ve=G.distr==2?Wn[Qt[1]]-Wn[Qt[0]]:Dt,ue=R._values=R.values(n,R.filter(n,Se,L,Nt,ve),L,Nt,ve);R._rotate=q==2?R.rotate(n,ue,L,Nt):0;let $t=R._size;R._size=ai(R.size(n,ue,L,g)),$t!=null&&R._size!=$t&&(y=!1)}),y}function bi(g){let y=!0;return Hr.forEach((R,L)=>{let G=R(n,L,yi,g);G!=ci[L]&&(y=!1),ci[L]=G}),y}function Gi(){for(let g=0;g<C.length;g++){let y=C[g];if(!y.show||!y._show)continue;let R=y.side,L=R%2,G,q,at=y.stroke(n,g),ft=R==0||R==3?-1:1,[vt,Dt]=y._found;if(y.label!=null){let Un=y.labelGap*ft,Yn=dn((y._lpos+Un)*ye);Pt(y.labelFont[0],at,"center",R==2?Jr:pu),u.save(),L==1?(G=q=0,u.translate(Yn,dn(M+ct/2)),u.rotate((R==3?-_o:_o)/2)):(G=dn(A+X/2),q=Yn);let Cs=Md(y.label)?y.label(n,g,vt,Dt):y.label;u.fillText(Cs,G,q),u.restore()}if(Dt==0)continue;let Nt=b[y.scale],Ut=L==0?X:ct,Qt=L==0?A:M,Se=y._splits,ve=Nt.distr==2?Se.map(Un=>Wn[Un]):Se,ue=Nt.distr==2?Wn[Se[1]]-Wn[Se[0]]:vt,$t=y.ticks,Vt=y.border,ze=$t.show?$t.size:0,qe=dn(ze*ye),yn=dn((y.alignTo==2?y._size-ze-y.gap:y.gap)*ye),De=y._rotate*-_o/180,Ke=m(y._pos*ye),Xn=(qe+yn)*ft,In=Ke+Xn;q=L==0?In:0,G=L==1?In:0;let ni=y.font[0],hi=y.align==1?er:y.align==2?fl:De>0?er:De<0?fl:L==0?"center":R==3?fl:er,Ai=De||L==1?"middle":R==2?Jr:pu;Pt(ni,at,hi,Ai);let $n=y.font[1]*y.lineGap,ii=Se.map(Un=>m(o(Un,Nt,Ut,Qt))),ui=y._values;for(let Un=0;Un<ui.length;Un++){let Yn=ui[Un];if(Yn!=null){L==0?G=ii[Un]:q=ii[Un],Yn=""+Yn;let Cs=Yn.indexOf(`
`)==-1?[Yn]:Yn.split(/\n/gm);for(let Fn=0;Fn<Cs.length;Fn++){let Jh=Cs[Fn];De?(u.save(),u.translate(G,q+Fn*$n),u.rotate(De),u.fillText(Jh,0,0),u.restore()):u.fillText(Jh,G,q+Fn*$n)}}}$t.show&&sn(ii,$t.filter(n,ve,g,Dt,ue),L,R,Ke,qe,Ue($t.width*ye,3),$t.stroke(n,g),$t.dash,$t.cap);let Ri=y.grid;Ri.show&&sn(ii,Ri.filter(n,ve,g,Dt,ue),L,L==0?2:1,L==0?M:A,L==0?ct:X,Ue(Ri.width*ye,3),Ri.stroke(n,g),Ri.dash,Ri.cap),Vt.show&&sn([Ke],[1],L==0?1:0,L==0?1:2,L==1?M:A,L==1?ct:X,Ue(Vt.width*ye,3),Vt.stroke(n,g),Vt.dash,Vt.cap)}Sn("drawAxes")}function ae(g){S.forEach((y,R)=>{R>0&&(y._paths=null,g&&(s==1?(y.min=null,y.max=null):y.facets.forEach(L=>{L.min=null,L.max=null})))})}let Ye=!1,Nn=!1,Re=[];function rn(){Nn=!1;for(let g=0;g<Re.length;g++)Sn(...Re[g]);Re.length=0}function Cn(){Ye||(Ng(Nh),Ye=!0)}function Pa(g,y=!1){Ye=!0,Nn=y,g(n),Nh(),y&&Re.length>0&&queueMicrotask(rn)}n.batch=Pa;function Nh(){if(rt&&(ce(),rt=!1),xt&&(Et(),xt=!1),gt){if(He(d,er,Xt),He(d,Jr,te),He(d,ca,F),He(d,ha,Rt),He(x,er,Xt),He(x,Jr,te),He(x,ca,F),He(x,ha,Rt),He(f,ca,Xe),He(f,ha,en),h.width=dn(Xe*ye),h.height=dn(en*ye),C.forEach(({_el:g,_show:y,_size:R,_pos:L,side:G})=>{if(g!=null)if(y){let q=G===3||G===0?R:0,at=G%2==1;He(g,at?"left":"top",L-q),He(g,at?"width":"height",R),He(g,at?"top":"left",at?te:Xt),He(g,at?"height":"width",at?Rt:F),nc(g,Fs)}else Qn(g,Fs)}),Xs=as=$s=O=J=$=Y=bt=E=null,Ct=1,$r(!0),Xt!=yt||te!=Ne||F!=Bt||Rt!=Wt){ae(!1);let g=F/Bt,y=Rt/Wt;if(pt&&!tt&&ht.left>=0){ht.left*=g,ht.top*=y,qs&&Ci(qs,dn(ht.left),0,F,Rt),Ks&&Ci(Ks,0,dn(ht.top),F,Rt);for(let R=0;R<ie.length;R++){let L=ie[R];L!=null&&(Oe[R]*=g,Dn[R]*=y,Ci(L,ai(Oe[R]),ai(Dn[R]),F,Rt))}}if(Be.show&&!nt&&Be.left>=0&&Be.width>0){Be.left*=g,Be.width*=g,Be.top*=y,Be.height*=y;for(let R in nl)He(Qs,R,Be[R])}yt=Xt,Ne=te,Bt=F,Wt=Rt}Sn("setSize"),gt=!1}Xe>0&&en>0&&(u.clearRect(0,0,h.width,h.height),Sn("drawClear"),w.forEach(g=>g()),Sn("draw")),Be.show&&nt&&(La(Be),nt=!1),pt&&tt&&(Rs(null,!0,!1),tt=!1),ut.show&&ut.live&&dt&&(tl(),dt=!1),l||(l=!0,n.status=1,Sn("ready")),rs=!1,Ye=!1}n.redraw=(g,y)=>{xt=y||!1,g!==!1?ls(T,D.min,D.max):Cn()};function Jo(g,y){let R=b[g];if(R.from==null){if($e==0){let L=R.range(n,y.min,y.max,g);y.min=L[0],y.max=L[1]}if(y.min>y.max){let L=y.min;y.min=y.max,y.max=L}if($e>1&&y.min!=null&&y.max!=null&&y.max-y.min<1e-16)return;g==T&&R.distr==2&&$e>0&&(y.min=gi(y.min,t[0]),y.max=gi(y.max,t[0]),y.min==y.max&&y.max++),H[g]=y,rt=!0,Cn()}}n.setScale=Jo;let Qo,jo,qs,Ks,Ih,Uh,Zs,Js,Fh,Oh,ke,Ve,os=!1;const Tn=ht.drag;let vn=Tn.x,Mn=Tn.y;pt&&(ht.x&&(Qo=ri(ig,x)),ht.y&&(jo=ri(sg,x)),D.ori==0?(qs=Qo,Ks=jo):(qs=jo,Ks=Qo),ke=ht.left,Ve=ht.top);const Be=n.select=cn({show:!0,over:!0,left:0,width:0,top:0,height:0},i.select),Qs=Be.show?ri(ng,Be.over?x:d):null;function La(g,y){if(Be.show){for(let R in g)Be[R]=g[R],R in nl&&He(Qs,R,g[R]);y!==!1&&Sn("setSelect")}}n.setSelect=La;function tm(g){if(S[g].show)j&&nc(jt[g],Fs);else if(j&&Qn(jt[g],Fs),pt){let R=At?ie[0]:ie[g];R!=null&&Ci(R,-10,-10,F,Rt)}}function ls(g,y,R){Jo(g,{min:y,max:R})}function wi(g,y,R,L){y.focus!=null&&rm(g),y.show!=null&&S.forEach((G,q)=>{q>0&&(g==q||g==null)&&(G.show=y.show,tm(q),s==2?(ls(G.facets[0].scale,null,null),ls(G.facets[1].scale,null,null)):ls(G.scale,null,null),Cn())}),R!==!1&&Sn("setSeries",g,y),L&&Yr("setSeries",n,g,y)}n.setSeries=wi;function em(g,y){cn(P[g],y)}function nm(g,y){g.fill=pe(g.fill||null),g.dir=Me(g.dir,-1),y=y??P.length,P.splice(y,0,g)}function im(g){g==null?P.length=0:P.splice(g,1)}n.addBand=nm,n.setBand=em,n.delBand=im;function sm(g,y){S[g].alpha=y,pt&&ie[g]!=null&&(ie[g].style.opacity=y),j&&jt[g]&&(jt[g].style.opacity=y)}let Vi,cs,As;const js={focus:!0};function rm(g){if(g!=As){let y=g==null,R=Ft.alpha!=1;S.forEach((L,G)=>{if(s==1||G>0){let q=y||G==0||G==g;L._focus=y?null:q,R&&sm(G,q?1:Ft.alpha)}}),As=g,R&&Cn()}}j&&qt&&xe(xu,Tt,g=>{ht._lock||(Yt(g),As!=null&&wi(null,js,!0,an.setSeries))});function Ti(g,y,R){let L=b[y];R&&(g=g/ye-(L.ori==1?te:Xt));let G=F;L.ori==1&&(G=Rt,g=G-g),L.dir==-1&&(g=G-g);let q=L._min,at=L._max,ft=g/G,vt=q+(at-q)*ft,Dt=L.distr;return Dt==3?Tr(10,vt):Dt==4?Sg(vt,L.asinh):Dt==100?L.bwd(vt):vt}function am(g,y){let R=Ti(g,T,y);return gi(R,t[0],Je,Qe)}n.valToIdx=g=>gi(g,t[0]),n.posToIdx=am,n.posToVal=Ti,n.valToPos=(g,y,R)=>b[y].ori==0?r(g,b[y],R?X:F,R?A:0):a(g,b[y],R?ct:Rt,R?M:0),n.setCursor=(g,y,R)=>{ke=g.left,Ve=g.top,Rs(null,y,R)};function kh(g,y){He(Qs,er,Be.left=g),He(Qs,ca,Be.width=y)}function Bh(g,y){He(Qs,Jr,Be.top=g),He(Qs,ha,Be.height=y)}let Wr=D.ori==0?kh:Bh,Xr=D.ori==1?kh:Bh;function om(){if(j&&ut.live)for(let g=s==2?1:0;g<S.length;g++){if(g==0&&re)continue;let y=ut.values[g],R=0;for(let L in y)zt[g][R++].firstChild.nodeValue=y[L]}}function tl(g,y){if(g!=null&&(g.idxs?g.idxs.forEach((R,L)=>{it[L]=R}):wg(g.idx)||it.fill(g.idx),ut.idx=it[0]),j&&ut.live){for(let R=0;R<S.length;R++)(R>0||s==1&&!re)&&lm(R,it[R]);om()}dt=!1,y!==!1&&Sn("setLegend")}n.setLegend=tl;function lm(g,y){let R=S[g],L=g==0&&z==2?Wn:t[g],G;re?G=R.values(n,g,y)??Jt:(G=R.value(n,y==null?null:L[y],g,y),G=G==null?Jt:{_:G}),ut.values[g]=G}function Rs(g,y,R){Fh=ke,Oh=Ve,[ke,Ve]=ht.move(n,ke,Ve),ht.left=ke,ht.top=Ve,pt&&(qs&&Ci(qs,dn(ke),0,F,Rt),Ks&&Ci(Ks,0,dn(Ve),F,Rt));let L,G=Je>Qe;Vi=Ie,cs=null;let q=D.ori==0?F:Rt,at=D.ori==1?F:Rt;if(ke<0||$e==0||G){L=ht.idx=null;for(let ft=0;ft<S.length;ft++){let vt=ie[ft];vt!=null&&Ci(vt,-10,-10,F,Rt)}qt&&wi(null,js,!0,g==null&&an.setSeries),ut.live&&(it.fill(L),dt=!0)}else{let ft,vt,Dt;s==1&&(ft=D.ori==0?ke:Ve,vt=Ti(ft,T),L=ht.idx=gi(vt,t[0],Je,Qe),Dt=V(t[0][L],D,q,0));let Nt=-10,Ut=-10,Qt=0,Se=0,ve=!0,ue="",$t="";for(let Vt=s==2?1:0;Vt<S.length;Vt++){let ze=S[Vt],qe=it[Vt],yn=qe==null?null:s==1?t[Vt][qe]:t[Vt][1][qe],De=ht.dataIdx(n,Vt,L,vt),Ke=De==null?null:s==1?t[Vt][De]:t[Vt][1][De];if(dt=dt||Ke!=yn||De!=qe,it[Vt]=De,Vt>0&&ze.show){let Xn=De==null?-10:De==L?Dt:V(s==1?t[0][De]:t[Vt][0][De],D,q,0),In=Ke==null?-10:N(Ke,s==1?b[ze.scale]:b[ze.facets[1].scale],at,0);if(qt&&Ke!=null){let ni=D.ori==1?ke:Ve,hi=pn(Ft.dist(n,Vt,De,In,ni));if(hi<Vi){let Ai=Ft.bias;if(Ai!=0){let $n=Ti(ni,ze.scale),ii=Ke>=0?1:-1,ui=$n>=0?1:-1;ui==ii&&(ui==1?Ai==1?Ke>=$n:Ke<=$n:Ai==1?Ke<=$n:Ke>=$n)&&(Vi=hi,cs=Vt)}else Vi=hi,cs=Vt}}if(dt||At){let ni,hi;D.ori==0?(ni=Xn,hi=In):(ni=In,hi=Xn);let Ai,$n,ii,ui,Ri,Un,Yn=!0,Cs=ot.bbox;if(Cs!=null){Yn=!1;let Fn=Cs(n,Vt);ii=Fn.left,ui=Fn.top,Ai=Fn.width,$n=Fn.height}else ii=ni,ui=hi,Ai=$n=ot.size(n,Vt);if(Un=ot.fill(n,Vt),Ri=ot.stroke(n,Vt),At)Vt==cs&&Vi<=Ft.prox&&(Nt=ii,Ut=ui,Qt=Ai,Se=$n,ve=Yn,ue=Un,$t=Ri);else{let Fn=ie[Vt];Fn!=null&&(Oe[Vt]=ii,Dn[Vt]=ui,wu(Fn,Ai,$n,Yn),Eu(Fn,Un,Ri),Ci(Fn,ai(ii),ai(ui),F,Rt))}}}}if(At){let Vt=Ft.prox,ze=As==null?Vi<=Vt:Vi>Vt||cs!=As;if(dt||ze){let qe=ie[0];qe!=null&&(Oe[0]=Nt,Dn[0]=Ut,wu(qe,Qt,Se,ve),Eu(qe,ue,$t),Ci(qe,ai(Nt),ai(Ut),F,Rt))}}}if(Be.show&&os)if(g!=null){let[ft,vt]=an.scales,[Dt,Nt]=an.match,[Ut,Qt]=g.cursor.sync.scales,Se=g.cursor.drag;if(vn=Se._x,Mn=Se._y,vn||Mn){let{left:ve,top:ue,width:$t,height:Vt}=g.select,ze=g.scales[Ut].ori,qe=g.posToVal,yn,De,Ke,Xn,In,ni=ft!=null&&Dt(ft,Ut),hi=vt!=null&&Nt(vt,Qt);ni&&vn?(ze==0?(yn=ve,De=$t):(yn=ue,De=Vt),Ke=b[ft],Xn=V(qe(yn,Ut),Ke,q,0),In=V(qe(yn+De,Ut),Ke,q,0),Wr(xi(Xn,In),pn(In-Xn))):Wr(0,q),hi&&Mn?(ze==1?(yn=ve,De=$t):(yn=ue,De=Vt),Ke=b[vt],Xn=N(qe(yn,Qt),Ke,at,0),In=N(qe(yn+De,Qt),Ke,at,0),Xr(xi(Xn,In),pn(In-Xn))):Xr(0,at)}else il()}else{let ft=pn(Fh-Ih),vt=pn(Oh-Uh);if(D.ori==1){let Qt=ft;ft=vt,vt=Qt}vn=Tn.x&&ft>=Tn.dist,Mn=Tn.y&&vt>=Tn.dist;let Dt=Tn.uni;Dt!=null?vn&&Mn&&(vn=ft>=Dt,Mn=vt>=Dt,!vn&&!Mn&&(vt>ft?Mn=!0:vn=!0)):Tn.x&&Tn.y&&(vn||Mn)&&(vn=Mn=!0);let Nt,Ut;vn&&(D.ori==0?(Nt=Zs,Ut=ke):(Nt=Js,Ut=Ve),Wr(xi(Nt,Ut),pn(Ut-Nt)),Mn||Xr(0,at)),Mn&&(D.ori==1?(Nt=Zs,Ut=ke):(Nt=Js,Ut=Ve),Xr(xi(Nt,Ut),pn(Ut-Nt)),vn||Wr(0,q)),!vn&&!Mn&&(Wr(0,0),Xr(0,0))}if(Tn._x=vn,Tn._y=Mn,g==null){if(R){if(Zh!=null){let[ft,vt]=an.scales;an.values[0]=ft!=null?Ti(D.ori==0?ke:Ve,ft):null,an.values[1]=vt!=null?Ti(D.ori==1?ke:Ve,vt):null}Yr(dl,n,ke,Ve,F,Rt,L)}if(qt){let ft=R&&an.setSeries,vt=Ft.prox;As==null?Vi<=vt&&wi(cs,js,!0,ft):Vi>vt?wi(null,js,!0,ft):cs!=As&&wi(cs,js,!0,ft)}}dt&&(ut.idx=L,tl()),y!==!1&&Sn("setCursor")}let hs=null;Object.defineProperty(n,"rect",{get(){return hs==null&&$r(!1),hs}});function $r(g=!1){g?hs=null:(hs=x.getBoundingClientRect(),Sn("syncRect",hs))}function zh(g,y,R,L,G,q,at){ht._lock||os&&g!=null&&g.movementX==0&&g.movementY==0||(el(g,y,R,L,G,q,at,!1,g!=null),g!=null?Rs(null,!0,!0):Rs(y,!0,!1))}function el(g,y,R,L,G,q,at,ft,vt){if(hs==null&&$r(!1),Yt(g),g!=null)R=g.clientX-hs.left,L=g.clientY-hs.top;else{if(R<0||L<0){ke=-10,Ve=-10;return}let[Dt,Nt]=an.scales,Ut=y.cursor.sync,[Qt,Se]=Ut.values,[ve,ue]=Ut.scales,[$t,Vt]=an.match,ze=y.axes[0].side%2==1,qe=D.ori==0?F:Rt,yn=D.ori==1?F:Rt,De=ze?q:G,Ke=ze?G:q,Xn=ze?L:R,In=ze?R:L;if(ve!=null?R=$t(Dt,ve)?o(Qt,b[Dt],qe,0):-10:R=qe*(Xn/De),ue!=null?L=Vt(Nt,ue)?o(Se,b[Nt],yn,0):-10:L=yn*(In/Ke),D.ori==1){let ni=R;R=L,L=ni}}vt&&(y==null||y.cursor.event.type==dl)&&((R<=1||R>=F-1)&&(R=Is(R,F)),(L<=1||L>=Rt-1)&&(L=Is(L,Rt))),ft?(Ih=R,Uh=L,[Zs,Js]=ht.move(n,R,L)):(ke=R,Ve=L)}const nl={width:0,height:0,left:0,top:0};function il(){La(nl,!1)}let Hh,Gh,Vh,Wh;function Xh(g,y,R,L,G,q,at){os=!0,vn=Mn=Tn._x=Tn._y=!1,el(g,y,R,L,G,q,at,!0,!1),g!=null&&(xe(pl,tc,$h,!1),Yr(gu,n,Zs,Js,F,Rt,null));let{left:ft,top:vt,width:Dt,height:Nt}=Be;Hh=ft,Gh=vt,Vh=Dt,Wh=Nt}function $h(g,y,R,L,G,q,at){os=Tn._x=Tn._y=!1,el(g,y,R,L,G,q,at,!1,!0);let{left:ft,top:vt,width:Dt,height:Nt}=Be,Ut=Dt>0||Nt>0,Qt=Hh!=ft||Gh!=vt||Vh!=Dt||Wh!=Nt;if(Ut&&Qt&&La(Be),Tn.setScale&&Ut&&Qt){let Se=ft,ve=Dt,ue=vt,$t=Nt;if(D.ori==1&&(Se=vt,ve=Nt,ue=ft,$t=Dt),vn&&ls(T,Ti(Se,T),Ti(Se+ve,T)),Mn)for(let Vt in b){let ze=b[Vt];Vt!=T&&ze.from==null&&ze.min!=Ie&&ls(Vt,Ti(ue+$t,Vt),Ti(ue,Vt))}il()}else ht.lock&&(ht._lock=!ht._lock,Rs(y,!0,g!=null));g!=null&&(hn(pl,tc),Yr(pl,n,ke,Ve,F,Rt,null))}function cm(g,y,R,L,G,q,at){if(ht._lock)return;Yt(g);let ft=os;if(os){let vt=!0,Dt=!0,Nt=10,Ut,Qt;D.ori==0?(Ut=vn,Qt=Mn):(Ut=Mn,Qt=vn),Ut&&Qt&&(vt=ke<=Nt||ke>=F-Nt,Dt=Ve<=Nt||Ve>=Rt-Nt),Ut&&vt&&(ke=ke<Zs?0:F),Qt&&Dt&&(Ve=Ve<Js?0:Rt),Rs(null,!0,!0),os=!1}ke=-10,Ve=-10,it.fill(null),Rs(null,!0,!0),ft&&(os=ft)}function Yh(g,y,R,L,G,q,at){ht._lock||(Yt(g),Vr(),il(),g!=null&&Yr(vu,n,ke,Ve,F,Rt,null))}function qh(){C.forEach(H_),U(n.width,n.height,!0)}Os(Ao,Sr,qh);const tr={};tr.mousedown=Xh,tr.mousemove=zh,tr.mouseup=$h,tr.dblclick=Yh,tr.setSeries=(g,y,R,L)=>{let G=an.match[2];R=G(n,y,R),R!=-1&&wi(R,L,!0,!1)},pt&&(xe(gu,x,Xh),xe(dl,x,zh),xe(_u,x,g=>{Yt(g),$r(!1)}),xe(xu,x,cm),xe(vu,x,Yh),lc.add(n),n.syncRect=$r);const Da=n.hooks=i.hooks||{};function Sn(g,y,R){Nn?Re.push([g,y,R]):g in Da&&Da[g].forEach(L=>{L.call(null,n,y,R)})}(i.plugins||[]).forEach(g=>{for(let y in g.hooks)Da[y]=(Da[y]||[]).concat(g.hooks[y])});const Kh=(g,y,R)=>R,an=cn({key:null,setSeries:!1,filters:{pub:Pu,sub:Pu},scales:[T,S[1]?S[1].scale:null],match:[Lu,Lu,Kh],values:[null,null]},ht.sync);an.match.length==2&&an.match.push(Kh),ht.sync=an;const Zh=an.key,sl=Wd(Zh);function Yr(g,y,R,L,G,q,at){an.filters.pub(g,y,R,L,G,q,at)&&sl.pub(g,y,R,L,G,q,at)}sl.sub(n);function hm(g,y,R,L,G,q,at){an.filters.sub(g,y,R,L,G,q,at)&&tr[g](null,y,R,L,G,q,at)}n.pub=hm;function um(){sl.unsub(n),lc.delete(n),xn.clear(),ic(Ao,Sr,qh),c.remove(),Tt?.remove(),Sn("destroy")}n.destroy=um;function rl(){Sn("init",i,t),Gr(t||i.data,!1),H[T]?Jo(T,H[T]):Vr(),nt=Be.show&&(Be.width>0||Be.height>0),tt=dt=!0,U(i.width,i.height)}return S.forEach(Ws),C.forEach(Bi),e?e instanceof HTMLElement?(e.appendChild(c),rl()):e(n,rl):rl(),n}Rn.assign=cn;Rn.fmtNum=rh;Rn.rangeNum=Ro;Rn.rangeLog=zo;Rn.rangeAsinh=ih;Rn.orient=Gs;Rn.pxRatio=ye;Rn.join=Dg;Rn.fmtDate=oh,Rn.tzDate=Vg;Rn.sync=Wd;{Rn.addGap=w_,Rn.clipGaps=Vo;let i=Rn.paths={points:Zd};i.linear=Qd,i.stepped=R_,i.bars=C_,i.spline=L_}const G_=0,np=1,ip=2,_a=40,sp=1,V_=2,W_=4,X_=8,$_=8;class rp{time;index;row_end;pose_end;track;x;y;z;box;cameras;sigma;body;pose;state;tracked;keypoints;keypoint_x;keypoint_y;confidence;sequence;sent_ms;constructor(t){const e=new DataView(t),n=e.getUint16(2,!0);this.sequence=e.getUint32(4,!0),this.sent_ms=Number(e.getBigUint64(16,!0))/1e6;const s=e.getUint32(24,!0),r=e.getUint32(28,!0),a=e.getUint32(32,!0);this.keypoints=e.getUint32(36,!0);let o=_a;const l=(h,u,f)=>{const d=new h(t,o,u);return o+=u*f,d};this.time=l(Float64Array,s,8),this.index=l(Uint32Array,s,4),this.row_end=l(Uint32Array,s,4),this.pose_end=l(Uint32Array,s,4),this.track=l(Int32Array,r,4);const c=()=>l(Float32Array,r,4);this.x=c(),this.y=c(),this.z=n&sp?c():null,this.box=n&V_?[c(),c(),c(),c()]:null,this.cameras=n&W_?l(Uint32Array,r,4):null,this.sigma=n&X_?c():null,this.body=l(Int32Array,a,4),this.pose=Array.from({length:7},()=>l(Float32Array,a,4)),this.keypoint_x=l(Float32Array,r*this.keypoints,4),this.keypoint_y=l(Float32Array,r*this.keypoints,4),this.state=l(Uint8Array,r,1),this.confidence=l(Uint8Array,r*this.keypoints,1),this.tracked=l(Uint8Array,a,1)}begin(t){return t===0?0:this.row_end[t-1]}pose_begin(t){return t===0?0:this.pose_end[t-1]}provenance(t){return this.state[t]&7}has_box(t){return(this.state[t]&$_)!==0}}function Y_(i){const t=new DataView(i),e=(t.getUint16(2,!0)&sp)!==0,n=t.getUint32(24,!0),s=r=>new Float32Array(i,_a+8*n+4*n*r,n);return{time:new Float64Array(i,_a,n),x:s(0),y:s(1),z:e?s(2):null,state:new Uint8Array(i,_a+n*(e?20:16),n)}}function q_(i){const t=new DataView(i),e=t.getUint32(28,!0),n=t.getUint32(32,!0);let s=_a;const r=c=>new Float32Array(i,(s+=4*c)-4*c,c),a=c=>new Int32Array(i,(s+=4*c)-4*c,c),o={x:r(e),y:r(e),track:a(e)},l={left:r(n),top:r(n),width:r(n),height:r(n),track:a(n)};return{camera:t.getUint32(24,!0),frame:t.getUint32(4,!0),sent_ms:Number(t.getBigUint64(16,!0))/1e6,width:t.getUint16(36,!0),height:t.getUint16(38,!0),points:o,boxes:l,jpeg:s<i.byteLength?new Blob([new Uint8Array(i,s)],{type:"image/jpeg"}):null}}const K_=i=>new DataView(i).getUint8(0),ju=["x","y","z","speed"];function Z_(i,t){const{time:e,x:n,y:s,z:r}=i;return Array.from(e,(a,o)=>{const[l,c]=[Math.max(0,o-1),Math.min(e.length-1,o+1)],h=e[c]-e[l];return h<=0||h>2*t?null:Math.hypot(n[c]-n[l],s[c]-s[l],r?r[c]-r[l]:0)/h})}function J_(i,t,e){const n=[],s=[];for(let r=0;r<i.time.length;++r)r>0&&i.time[r]-i.time[r-1]>e&&(n.push((i.time[r]+i.time[r-1])/2),s.push(null)),n.push(i.time[r]),s.push(t[r]);return[n,s]}const Q_=(i,t)=>(i.state[t]&7)===np||(i.state[t]&7)===ip;function j_(i,t){const e=i.time.length,n=Array.from({length:e},(r,a)=>Q_(i,a));if(!n.includes(!0))return[t];const s=r=>n[r]||r>0&&n[r-1]||r+1<e&&n[r+1];return[n.map((r,a)=>r?null:t[a]),n.map((r,a)=>s(a)?t[a]:null)]}class t0{constructor(t,e,n,s){this.state=t,this.colours=e,this.motion=n,this.seek=s;const r=document.querySelector("#coordinates");for(const a of ju){const o=document.createElement("button");o.textContent=a,o.className="chip",o.addEventListener("click",()=>{this.chosen.delete(a)||this.chosen.add(a),this.update()}),this.buttons.set(a,o),r.append(o)}new ResizeObserver(()=>this.update()).observe(this.container)}container=document.querySelector("#plots");hint=document.querySelector("#plot_hint");key=document.querySelector("#plot_key");buttons=new Map;chosen=new Set(["x","y","z"]);plots=[];courses=new Map;built_for="";busy=!1;refreshed=0;visible=!1;forget(){this.courses.clear(),this.built_for=""}async update(){const t=this.motion(),e=t.scene.frame==="space";this.buttons.get("z").hidden=!e;for(const[h,u]of this.buttons)u.classList.toggle("on",this.chosen.has(h));if(!this.visible||this.busy)return;const n=[...this.state.selected].slice(-6),s=ju.filter(h=>this.chosen.has(h)&&(h!=="z"||e));this.hint.hidden=n.length>0;const r=t.scene.kind==="live";r&&performance.now()-this.refreshed>250&&this.forget();const a=new Map(t.scene.tracks.map(h=>[h.id,`${h.rows}.${h.version}`])),o=`${n.map(h=>`${h}:${a.get(h)}`)} ${s} ${this.container.clientWidth} ${this.container.clientHeight} ${this.state.dark} ${t.last}`;if(o===this.built_for||this.container.clientWidth===0)return this.draw();this.busy=!0,this.refreshed=performance.now();for(const h of n){const u=a.get(h)??"";this.courses.get(h)?.version!==u&&this.courses.set(h,{course:await t.course(h),version:u})}this.busy=!1,this.built_for=o,this.key.replaceChildren(...n.map(h=>this.key_of(h)));const l=this.zoom();for(const h of this.plots)h.destroy();if(this.plots=[],n.length===0)return;const c=Math.max(96,Math.floor(this.container.clientHeight/Math.max(1,s.length))-4);for(const h of s)this.plots.push(this.build(h,n,c));if(l&&!r)for(const h of this.plots)h.setScale("x",l);this.draw(),this.update()}zoom(){const t=this.plots[0],e=t?.data[0],{min:n,max:s}=t?.scales.x??{};return!e?.length||n===void 0||n===null||s===void 0||s===null?null:n>e[0]||s<e[e.length-1]?{min:n,max:s}:null}draw(){const{range:t}=this.state,e=t&&this.plots.length?fd(this.motion(),t):null;for(const n of this.plots){const s=n.root.querySelector(".marked");if(s.hidden=!e,e){const[o,l]=e.map(c=>Math.max(-4,Math.min(n.over.clientWidth+4,n.valToPos(c,"x"))));s.style.left=`${o}px`,s.style.width=`${Math.max(2,l-o)}px`}const r=n.root.querySelector(".playhead"),a=n.valToPos(this.state.time,"x");r.style.transform=`translateX(${a}px)`,r.hidden=!(a>=0&&a<=n.over.clientWidth)}}key_of(t){const e=document.createElement("span"),n=document.createElement("i");return n.style.background=this.line_colour(t),e.append(n,wr(this.motion().scene.tracks.find(s=>s.id===t),t)),e}line_colour(t){const n=[...this.state.selected].slice(-6).filter(l=>this.colours.css(l)===this.colours.css(t)),[s,r,a]=this.colours.rgb(t).map(l=>Math.round(255*l)),o=n.length<2?0:Math.round(60*n.indexOf(t)/(n.length-1));return o===0?`rgb(${s},${r},${a})`:`color-mix(in oklab, rgb(${s},${r},${a}), ${this.state.dark?"white":"black"} ${o}%)`}build(t,e,n){const{scene:s}=this.motion(),r=Math.max(2.5/Math.max(s.rate,.1),.001),a=[],o=[];for(const d of e){const{course:x}=this.courses.get(d),v=t==="speed"?Z_(x,r):x[t]??[];j_(x,v).forEach((m,p)=>{a.push(J_(x,m,r)),o.push({stroke:this.line_colour(d),width:1.5,dash:p?[3,3]:void 0,spanGaps:!1,points:{show:!1}})})}const l=getComputedStyle(document.body),c=d=>l.getPropertyValue(d).trim(),h=(s.frame==="image"?"px":"m")+(t==="speed"?"/s":""),u={stroke:c("--muted"),grid:{stroke:c("--line"),width:1},ticks:{show:!1},font:`10px ${l.fontFamily}`},f=new Rn({width:this.container.clientWidth,height:n,legend:{show:!1},padding:[8,10,0,0],cursor:{sync:{key:"marey"},drag:{x:!0,y:!1},points:{show:!1}},scales:{x:{time:!1}},hooks:{draw:[()=>this.draw()]},axes:[{...u,size:22,gap:2,values:(d,x)=>x.map(v=>`${+v.toFixed(3)} s`)},{...u,size:46,gap:4,label:`${t} / ${h}`,labelSize:16,labelFont:`600 11px ${l.fontFamily}`}],series:[{},...o]},a.length>1?Rn.join(a):a[0],this.container);for(const d of["marked","playhead"])f.over.append(Object.assign(document.createElement("div"),{className:d}));return f.over.addEventListener("click",d=>d.shiftKey||this.seek(f.posToVal(d.offsetX,"x"))),f.over.addEventListener("mousedown",d=>this.mark(f,d),{capture:!0}),f}mark(t,e){const n=this.motion();if(!e.shiftKey||e.button!==0||!n.scene.can_edit)return;e.stopImmediatePropagation(),e.preventDefault();const s=o=>{const l=t.over.getBoundingClientRect();return t.posToVal(Math.max(0,Math.min(l.width,o-l.left)),"x")},r=s(e.clientX),a=o=>{this.state.range=dd(n,r,s(o.clientX)),this.state.changed()};a(e),document.addEventListener("mousemove",a),document.addEventListener("mouseup",()=>document.removeEventListener("mousemove",a),{once:!0})}}const tf=160,e0=600,n0=4;class i0{scene;on_change=()=>{};begins=[];revision=0;here=new Map;asked=new Set;constructor(t){this.scene=t,this.take(t)}get first(){return this.begins[0]??0}get last(){return this.scene.last??0}take(t){this.scene=t,this.begins=(t.chunks??[]).map(n=>n[0]);const e=Math.min(this.begins.length,tf);for(let n=0;n<e;++n)this.fetch(n);this.on_change()}at(t){const e=Math.max(0,mo(this.begins,t+1e-9));if(e>=this.begins.length)return null;for(let s=1;s<=n0&&e+s<this.begins.length;++s)this.fetch(e+s);const n=this.chunk(e);return n?{chunk:n,k:Math.max(0,mo(n.time,t+1e-9))}:null}neighbour(t,e){const n=t.k+e;if(n>=0&&n<t.chunk.time.length)return{chunk:t.chunk,k:n};const s=mo(this.begins,t.chunk.time[0]+1e-9)+e;if(s<0||s>=this.begins.length)return null;const r=this.chunk(s);return r?{chunk:r,k:e>0?0:r.time.length-1}:null}async course(t){const e=await fetch(`course?track=${t}`);return Y_(await e.arrayBuffer())}density(){const t=this.scene.chunks??[];if(t.length>tf||this.here.size<t.length)return t.map(([n,s,r])=>[n,r/Math.max(1,s)]);const e=[];for(let n=0;n<t.length;++n){const{chunk:s}=this.here.get(n);for(let r=0;r<s.time.length;++r)e.push([s.time[r],s.row_end[r]-s.begin(r)])}return e}chunk(t){const e=this.here.get(t);return(!e||e.version!==this.version(t))&&this.fetch(t),e?(this.here.delete(t),this.here.set(t,e),e.chunk):null}version(t){return this.scene.chunks?.[t]?.[3]??0}async fetch(t){const e=this.version(t),n=this.here.get(t);if(!(n?.version===e||this.asked.has(t))){this.asked.add(t);try{const s=await fetch(`stretch?n=${t}`);if(!s.ok)return;this.here.set(t,{chunk:new rp(await s.arrayBuffer()),version:e}),n&&++this.revision,this.here.size>e0&&this.here.delete(this.here.keys().next().value),this.on_change()}catch{}finally{this.asked.delete(t)}this.version(t)!==e&&this.fetch(t)}}}const s0=2e3;class r0{constructor(t,e){this.received=t,this.live=e}socket=null;ever=!1;connect(){if(typeof WebSocket>"u"){this.received.lost(),this.received.server_message(`This browser has no WebSockets${this.without("take a current one")}`);return}const t=new WebSocket(`ws://${location.host}/socket`);t.binaryType="arraybuffer",t.onopen=()=>{this.socket=t,this.ever=!0,this.received.server_message(""),this.received.opened()},t.onmessage=({data:e})=>typeof e=="string"?this.received.text(e):this.received.bytes(e),t.onclose=()=>{this.socket===t?this.received.server_message("The program that showed this has ended."):this.ever||this.received.server_message(`The program cannot be heard: a proxy or an extension may let no WebSocket through${this.without("open the page without it")}`),this.socket=null,this.received.lost(),setTimeout(()=>this.connect(),s0)}}get open(){return this.socket?.readyState===WebSocket.OPEN}send(t){return!this.socket||!this.open?!1:(this.socket.send(t),!0)}without(t){return this.live?`, by which a live run comes: ${t}.`:`; the recording is shown, but neither its video nor edits: ${t} for those.`}}const Ba=30;class a0{constructor(t,e){this.state=t,this.colours=e,this.body.className="rows",this.list.append(this.body),this.list.addEventListener("scroll",()=>this.draw()),this.filter.addEventListener("input",()=>this.sift()),document.querySelector("#none").addEventListener("click",()=>{t.selected.clear(),t.hidden.clear(),t.changed()});for(const n of["name","seen"])document.querySelector(`#by_${n}`).addEventListener("click",()=>{this.by=n,this.sift()});t.on_change(()=>this.draw()),new ResizeObserver(()=>this.draw()).observe(this.list)}list=document.querySelector("#tracks");filter=document.querySelector("#filter");count=document.querySelector("#count");entries=[];shown=[];body=document.createElement("div");rows=new Map;by="name";say_what_counts(t){const e=document.querySelector("#by_seen");ge(e,t?"Present %":"Seen %"),e.title=t?"Share of the instants that have it: these places were computed, not seen by cameras":"Share of the instants at which cameras saw it"}take(t,e,n){const s=e instanceof vs?e:null,r=({id:a,label:o})=>!s||s.is_listed(a)||o!==""||this.state.selected.has(a);this.entries=t.tracks.filter(r).map(a=>({track:a,name:wr(a,a.id),measured:n(a),gone:s!==null&&!s.is_there(a.id)})),this.sift()}sift(){const t=this.filter.value.trim().toLowerCase();this.shown=this.entries.filter(s=>t===""||`${s.name} ${s.track.team}`.toLowerCase().includes(t));const e=(s,r)=>s.track.team.localeCompare(r.track.team)||s.name.localeCompare(r.name,void 0,{numeric:!0}),n=this.by==="name"?e:(s,r)=>(s.measured??0)-(r.measured??0)||e(s,r);this.shown.sort((s,r)=>Number(s.gone)-Number(r.gone)||n(s,r)),document.querySelector("#by_name").classList.toggle("on",this.by==="name"),document.querySelector("#by_seen").classList.toggle("on",this.by==="seen"),this.draw()}draw(){const{selected:t,hidden:e}=this.state,n=o=>o.filter(l=>!l.gone).length,s=[`${n(this.shown)}${this.shown.length<this.entries.length?` of ${n(this.entries)}`:""}`];if(t.size&&s.push(`${t.size} selected`),e.size&&s.push(`${e.size} hidden`),this.count.textContent=s.join(" · "),this.list.clientHeight===0)return;this.body.style.height=`${this.shown.length*Ba}px`;const r=Math.max(0,Math.floor(this.list.scrollTop/Ba)-4),a=Math.min(this.shown.length,r+Math.ceil(this.list.clientHeight/Ba)+8);this.place(this.shown.slice(r,a),r)}place(t,e){const n=new Set(t.map(s=>s.track.id));for(const[s,r]of this.rows)n.has(s)||(r.element.remove(),this.rows.delete(s));t.forEach((s,r)=>{const{id:a}=s.track,o=this.rows.get(a)??this.row(a);this.rows.set(a,o),this.fill(o,s,e+r),this.body.children[r]!==o.element&&this.body.insertBefore(o.element,this.body.children[r]??null)})}fill(t,e,n){const{id:s}=e.track,{selected:r,hidden:a}=this.state;t.element.style.top=`${n*Ba}px`,t.element.classList.toggle("selected",r.has(s)),t.element.classList.toggle("hidden",a.has(s)),t.element.classList.toggle("gone",e.gone),t.swatch.style.background=this.colours.css(s),t.name.textContent!==e.name&&(t.name.textContent=e.name),t.name.title=e.track.team?`${e.name}, ${e.track.team}`:e.name,t.name.setAttribute("aria-pressed",`${r.has(s)}`),t.bar.hidden=e.measured===null,t.bar.style.width=`${(100*(e.measured??0)).toFixed(1)}%`,t.percent.textContent=e.measured===null?"":e.measured>.9995?"100":(100*e.measured).toFixed(1),t.eye.title=a.has(s)?"Show":"Hide",t.eye.setAttribute("aria-label",`${t.eye.title} ${e.name}`)}row(t){const e=document.createElement("div");e.className="row",e.dataset.id=`${t}`;const n=document.createElement("span");n.className="swatch";const s=document.createElement("button");s.className="name",s.addEventListener("click",()=>this.state.toggle_selected(t)),e.addEventListener("mouseenter",()=>{this.state.hover=t,e.classList.add("hover"),this.state.changed_hover()}),e.addEventListener("mouseleave",()=>{this.state.hover=null,e.classList.remove("hover"),this.state.changed_hover()});const r=document.createElement("span");r.className="share";const a=document.createElement("i");r.append(a);const o=document.createElement("span");o.className="percent";const l=document.createElement("button");return l.className="eye",l.addEventListener("click",()=>{this.state.hidden.delete(t)||this.state.hidden.add(t),this.state.changed()}),e.append(n,s,r,o,l),{element:e,swatch:n,name:s,bar:a,percent:o,eye:l}}}const vl=i=>String(i).padStart(2,"0");function _r(i){const t=i<-.005?"−":"",e=Math.abs(i),n=Math.floor(e/60),s=`${vl(Math.floor(e%60))}.${vl(Math.floor(e*100%100))}`;return n>=60?`${t}${Math.floor(n/60)}:${vl(n%60)}:${s}`:`${t}${n}:${s}`}class o0{constructor(t,e,n){this.state=t,this.motion=e;for(const s of Na)this.speed.add(new Option(`${s<.1?"1/20":s<.25?"1/10":s===.25?"¼":s===.5?"½":s}×`,`${s}`));this.speed.value="1",this.speed.addEventListener("change",()=>{t.speed=Number(this.speed.value),t.changed(),this.speed.blur()}),this.play.addEventListener("click",()=>this.toggle()),document.querySelector("#back").addEventListener("click",()=>n(-1)),document.querySelector("#forth").addEventListener("click",()=>n(1)),this.to_live.addEventListener("click",()=>{t.stays_at_end=!0,t.changed()}),this.strip.addEventListener("pointerdown",s=>{this.strip.setPointerCapture(s.pointerId),this.marked_from=s.shiftKey&&e().scene.can_edit?this.time_at(s):null,this.scrub(s)}),this.strip.addEventListener("pointermove",s=>{this.strip.hasPointerCapture(s.pointerId)&&this.scrub(s)})}strip=document.querySelector("#strip");play=document.querySelector("#play");now=document.querySelector("#now");total=document.querySelector("#total");speed=document.querySelector("#speed");to_live=document.querySelector("#live");shape=null;shaped_for="";ran=null;marked_from=null;style=getComputedStyle(this.strip);toggle(){const{state:t}=this,e=this.motion();e.scene.kind==="live"?(t.stays_at_end=!t.stays_at_end,t.playing=!1):(t.playing=!t.playing,t.playing&&t.time>=e.last-1e-6&&(t.time=e.first)),t.changed()}faster(t){const e=Na.indexOf(this.state.speed)+t;e<0||e>=Na.length||(this.state.speed=Na[e],this.speed.value=`${this.state.speed}`,this.state.changed())}draw(){const{state:t}=this,e=this.motion(),n=e.scene.kind==="live",s=n?t.stays_at_end:t.playing;this.play.classList.toggle("running",s),this.ran!==s&&(this.ran=s,this.play.title=s?"Pause (space)":"Play (space)",this.play.setAttribute("aria-label",s?"Pause":"Play")),this.to_live.hidden=!n||t.stays_at_end,this.speed.hidden=n,ge(this.now,_r(n?t.time:t.time-e.first)),ge(this.total,n?t.stays_at_end?"live":`${_r(e.last-t.time)} behind`:_r(e.last-e.first)),this.draw_strip(e)}time_at(t){const e=this.motion(),n=this.strip.getBoundingClientRect(),s=Math.max(0,Math.min(1,(t.clientX-n.left)/n.width));return e.first+s*(e.last-e.first)}scrub(t){this.state.time=this.time_at(t),this.state.stays_at_end=!1,this.marked_from!==null&&(this.state.range=dd(this.motion(),this.marked_from,this.state.time)),this.state.changed()}draw_strip(t){const e=Math.min(devicePixelRatio,2),{clientWidth:n,clientHeight:s}=this.strip;(this.strip.width!==Math.round(n*e)||this.strip.height!==Math.round(s*e))&&(this.strip.width=Math.round(n*e),this.strip.height=Math.round(s*e));const r=this.strip.getContext("2d");r.setTransform(e,0,0,e,0,0),r.clearRect(0,0,n,s);const{style:a}=this,o=Math.max(1e-9,t.last-t.first),l=f=>(f-t.first)/o*n,c=t.density(),h=`${n} ${c.length} ${c[0]?.[0]} ${t.last} ${t.revision}`;h!==this.shaped_for&&(this.shaped_for=h,this.shape=this.shape_of(c,l,n,s)),r.fillStyle=a.getPropertyValue("--strip"),this.shape&&r.fill(this.shape);const u=l(Math.max(t.first,Math.min(t.last,this.state.time)));if(r.fillStyle=a.getPropertyValue("--past"),r.save(),r.beginPath(),r.rect(0,0,u,s),r.clip(),this.shape&&r.fill(this.shape),r.restore(),this.state.range){const[f,d]=fd(t,this.state.range).map(x=>Math.max(0,Math.min(n,l(x))));r.fillStyle=a.getPropertyValue("--marked"),r.fillRect(f,0,Math.max(2,d-f),s),r.fillStyle=a.getPropertyValue("--warn");for(const x of[f,Math.max(f+2,d)-2])r.fillRect(x,0,2,s)}r.fillStyle=a.getPropertyValue("--accent"),r.fillRect(Math.max(0,Math.min(n-2,u-1)),0,2,s)}shape_of(t,e,n,s){const r=Math.max(1,Math.floor(n/2)),a=new Float64Array(r),o=new Float64Array(r);for(let h=0;h<t.length;++h){const u=Math.max(0,Math.min(r-1,Math.floor(e(t[h][0])/2))),f=h+1<t.length?Math.max(u+1,Math.min(r,Math.floor(e(t[h+1][0])/2))):r;for(let d=u;d<f;++d)a[d]+=t[h][1],++o[d]}let l=1e-9;for(let h=0;h<r;++h)o[h]&&(l=Math.max(l,a[h]/o[h]));const c=new Path2D;for(let h=0;h<r;++h){const u=o[h]?.78*s*(a[h]/o[h])/l:0;c.rect(2*h,s-2-u,2,u+2)}return c}}class l0{element=document.createElement("div");overlay;constructor(t,e){this.overlay=new jc(t,e),this.element.className="view blind";const n=document.createElement("p");n.className="hint",n.textContent="This browser draws nothing in space, for it has no WebGL: switch hardware acceleration on in its settings, or take another browser. The list and the plots work all the same.",this.element.append(n)}take(){}resize(t,e){this.overlay.resize(t,e)}draw(){}reset(){}}/**
 * @license
 * Copyright 2010-2026 Three.js Authors
 * SPDX-License-Identifier: MIT
 */const ph="187",yr={ROTATE:0,DOLLY:1,PAN:2},xr={ROTATE:0,PAN:1,DOLLY_PAN:2,DOLLY_ROTATE:3},c0=0,ef=1,h0=2,xo=1,u0=2,fa=3,Bs=0,Vn=1,Qi=2,Er=0,xa=1,nf=2,sf=3,rf=4,f0=5,gr=100,d0=101,p0=102,m0=103,g0=104,_0=200,x0=201,v0=202,M0=203,ap=204,op=205,S0=206,y0=207,E0=208,b0=209,w0=210,T0=211,A0=212,R0=213,C0=214,hc=0,uc=1,fc=2,Sa=3,dc=4,pc=5,mc=6,gc=7,mh=0,P0=1,L0=2,ns=0,lp=1,cp=2,hp=3,up=4,fp=5,dp=6,pp=7,mp=300,Pr=301,ya=302,Ml=303,Sl=304,_c=1e3,ji=1001,xc=1002,An=1003,D0=1004,za=1005,Gn=1006,yl=1007,Ss=1008,jn=1009,gp=1010,_p=1011,Ea=1012,gh=1013,Fi=1014,Mi=1015,Oi=1016,_h=1017,xh=1018,Lr=1020,xp=35902,vp=35899,Mp=1021,Sp=1022,Ni=1023,bs=1026,ys=1027,vh=1028,Mh=1029,zs=1030,Sh=1031,yh=1033,vo=33776,Mo=33777,So=33778,yo=33779,vc=35840,Mc=35841,Sc=35842,yc=35843,Ec=36196,bc=37492,wc=37496,Tc=37488,Ac=37489,Po=37490,Rc=37491,Cc=37808,Pc=37809,Lc=37810,Dc=37811,Nc=37812,Ic=37813,Uc=37814,Fc=37815,Oc=37816,kc=37817,Bc=37818,zc=37819,Hc=37820,Gc=37821,Vc=36492,Wc=36494,Xc=36495,$c=36283,Yc=36284,Lo=36285,qc=36286,N0=3200,Kc=0,I0=1,Ms="",oi="srgb",Do="srgb-linear",No="linear",Ce="srgb",El=7680,U0=519,F0=512,O0=513,k0=514,yp=515,B0=516,z0=517,Ep=518,bp=519,H0=35044,Io=35048,af="300 es",Si=2e3,ba=2001;function G0(i){for(let t=i.length-1;t>=0;--t)if(i[t]>=65535)return!0;return!1}function Uo(i){return document.createElementNS("http://www.w3.org/1999/xhtml",i)}function V0(){const i=Uo("canvas");return i.style.display="block",i}const of={};function lf(...i){const t="THREE."+i.shift();console.log(t,...i)}function wp(i){const t=i[0];if(typeof t=="string"&&t.startsWith("TSL:")){const e=i[1];e&&e.isStackTrace?i[0]+=" "+e.getLocation():i[1]='Stack trace not available. Enable "THREE.Node.captureStackTrace" to capture stack traces.'}return i}function Kt(...i){i=wp(i);const t="THREE."+i.shift();{const e=i[0];e&&e.isStackTrace?console.warn(e.getError(t)):console.warn(t,...i)}}function Ee(...i){i=wp(i);const t="THREE."+i.shift();{const e=i[0];e&&e.isStackTrace?console.error(e.getError(t)):console.error(t,...i)}}function Eo(...i){const t=i.join(" ");t in of||(of[t]=!0,Kt(...i))}function W0(i,t,e){return new Promise(function(n,s){function r(){switch(i.clientWaitSync(t,i.SYNC_FLUSH_COMMANDS_BIT,0)){case i.WAIT_FAILED:s();break;case i.TIMEOUT_EXPIRED:setTimeout(r,e);break;default:n()}}setTimeout(r,e)})}const X0={[hc]:hc,[fc]:mc,[dc]:dc,[Sa]:pc,[uc]:uc,[mc]:fc,[gc]:gc,[pc]:Sa};class Ts{addEventListener(t,e){this._listeners===void 0&&(this._listeners={});const n=this._listeners;n[t]===void 0&&(n[t]=[]),n[t].indexOf(e)===-1&&n[t].push(e)}hasEventListener(t,e){const n=this._listeners;return n===void 0?!1:n[t]!==void 0&&n[t].indexOf(e)!==-1}removeEventListener(t,e){const n=this._listeners;if(n===void 0)return;const s=n[t];if(s!==void 0){const r=s.indexOf(e);r!==-1&&s.splice(r,1)}}dispatchEvent(t){const e=this._listeners;if(e===void 0)return;const n=e[t.type];if(n!==void 0){t.target=this;const s=n.slice(0);for(let r=0,a=s.length;r<a;r++)s[r].call(this,t);t.target=null}}}const Pn=["00","01","02","03","04","05","06","07","08","09","0a","0b","0c","0d","0e","0f","10","11","12","13","14","15","16","17","18","19","1a","1b","1c","1d","1e","1f","20","21","22","23","24","25","26","27","28","29","2a","2b","2c","2d","2e","2f","30","31","32","33","34","35","36","37","38","39","3a","3b","3c","3d","3e","3f","40","41","42","43","44","45","46","47","48","49","4a","4b","4c","4d","4e","4f","50","51","52","53","54","55","56","57","58","59","5a","5b","5c","5d","5e","5f","60","61","62","63","64","65","66","67","68","69","6a","6b","6c","6d","6e","6f","70","71","72","73","74","75","76","77","78","79","7a","7b","7c","7d","7e","7f","80","81","82","83","84","85","86","87","88","89","8a","8b","8c","8d","8e","8f","90","91","92","93","94","95","96","97","98","99","9a","9b","9c","9d","9e","9f","a0","a1","a2","a3","a4","a5","a6","a7","a8","a9","aa","ab","ac","ad","ae","af","b0","b1","b2","b3","b4","b5","b6","b7","b8","b9","ba","bb","bc","bd","be","bf","c0","c1","c2","c3","c4","c5","c6","c7","c8","c9","ca","cb","cc","cd","ce","cf","d0","d1","d2","d3","d4","d5","d6","d7","d8","d9","da","db","dc","dd","de","df","e0","e1","e2","e3","e4","e5","e6","e7","e8","e9","ea","eb","ec","ed","ee","ef","f0","f1","f2","f3","f4","f5","f6","f7","f8","f9","fa","fb","fc","fd","fe","ff"],bo=Math.PI/180,Zc=180/Math.PI;function Ta(){const i=Math.random()*4294967295|0,t=Math.random()*4294967295|0,e=Math.random()*4294967295|0,n=Math.random()*4294967295|0;return(Pn[i&255]+Pn[i>>8&255]+Pn[i>>16&255]+Pn[i>>24&255]+"-"+Pn[t&255]+Pn[t>>8&255]+"-"+Pn[t>>16&15|64]+Pn[t>>24&255]+"-"+Pn[e&63|128]+Pn[e>>8&255]+"-"+Pn[e>>16&255]+Pn[e>>24&255]+Pn[n&255]+Pn[n>>8&255]+Pn[n>>16&255]+Pn[n>>24&255]).toLowerCase()}function fe(i,t,e){return Math.max(t,Math.min(e,i))}function $0(i,t){return(i%t+t)%t}function bl(i,t,e){return(1-e)*i+e*t}function Y0(i){return Math.pow(2,Math.floor(Math.log(i)/Math.LN2))}function Eh(i){switch(i.constructor){case Uint32Array:return 4294967295;case Uint16Array:return 65535;case Uint8Array:case Uint8ClampedArray:return 255;case Int32Array:return 2147483647;case Int16Array:return 32767;case Int8Array:return 127;default:return}}function q0(i,t){if(t.constructor===Float32Array)return i;const e=Eh(t);if(e===void 0)throw new Error("THREE.MathUtils: Invalid component type.");return Math.max(i/e,-1)}function K0(i,t){if(t.constructor===Float32Array)return i;const e=Eh(t);if(e===void 0)throw new Error("THREE.MathUtils: Invalid component type.");return Math.round(i*e)}const Z0={DEG2RAD:bo};class ee{static{this.prototype.isVector2=!0}constructor(t=0,e=0){this.x=t,this.y=e}get width(){return this.x}set width(t){this.x=t}get height(){return this.y}set height(t){this.y=t}set(t,e){return this.x=t,this.y=e,this}setScalar(t){return this.x=t,this.y=t,this}setX(t){return this.x=t,this}setY(t){return this.y=t,this}setComponent(t,e){switch(t){case 0:this.x=e;break;case 1:this.y=e;break;default:throw new Error("THREE.Vector2: index is out of range: "+t)}return this}getComponent(t){switch(t){case 0:return this.x;case 1:return this.y;default:throw new Error("THREE.Vector2: index is out of range: "+t)}}clone(){return new this.constructor(this.x,this.y)}copy(t){return this.x=t.x,this.y=t.y,this}add(t){return this.x+=t.x,this.y+=t.y,this}addScalar(t){return this.x+=t,this.y+=t,this}addVectors(t,e){return this.x=t.x+e.x,this.y=t.y+e.y,this}addScaledVector(t,e){return this.x+=t.x*e,this.y+=t.y*e,this}sub(t){return this.x-=t.x,this.y-=t.y,this}subScalar(t){return this.x-=t,this.y-=t,this}subVectors(t,e){return this.x=t.x-e.x,this.y=t.y-e.y,this}multiply(t){return this.x*=t.x,this.y*=t.y,this}multiplyScalar(t){return this.x*=t,this.y*=t,this}divide(t){return this.x/=t.x,this.y/=t.y,this}divideScalar(t){return this.multiplyScalar(1/t)}applyMatrix3(t){const e=this.x,n=this.y,s=t.elements;return this.x=s[0]*e+s[3]*n+s[6],this.y=s[1]*e+s[4]*n+s[7],this}min(t){return this.x=Math.min(this.x,t.x),this.y=Math.min(this.y,t.y),this}max(t){return this.x=Math.max(this.x,t.x),this.y=Math.max(this.y,t.y),this}clamp(t,e){return this.x=fe(this.x,t.x,e.x),this.y=fe(this.y,t.y,e.y),this}clampScalar(t,e){return this.x=fe(this.x,t,e),this.y=fe(this.y,t,e),this}clampLength(t,e){const n=this.length();return this.divideScalar(n||1).multiplyScalar(fe(n,t,e))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this}negate(){return this.x=-this.x,this.y=-this.y,this}dot(t){return this.x*t.x+this.y*t.y}cross(t){return this.x*t.y-this.y*t.x}lengthSq(){return this.x*this.x+this.y*this.y}length(){return Math.sqrt(this.x*this.x+this.y*this.y)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)}normalize(){return this.divideScalar(this.length()||1)}angle(){return Math.atan2(-this.y,-this.x)+Math.PI}angleTo(t){const e=Math.sqrt(this.lengthSq()*t.lengthSq());if(e===0)return Math.PI/2;const n=this.dot(t)/e;return Math.acos(fe(n,-1,1))}distanceTo(t){return Math.sqrt(this.distanceToSquared(t))}distanceToSquared(t){const e=this.x-t.x,n=this.y-t.y;return e*e+n*n}manhattanDistanceTo(t){return Math.abs(this.x-t.x)+Math.abs(this.y-t.y)}setLength(t){return this.normalize().multiplyScalar(t)}lerp(t,e){return this.x+=(t.x-this.x)*e,this.y+=(t.y-this.y)*e,this}lerpVectors(t,e,n){return this.x=t.x+(e.x-t.x)*n,this.y=t.y+(e.y-t.y)*n,this}equals(t){return t.x===this.x&&t.y===this.y}fromArray(t,e=0){return this.x=t[e],this.y=t[e+1],this}toArray(t=[],e=0){return t[e]=this.x,t[e+1]=this.y,t}fromBufferAttribute(t,e){return this.x=t.getX(e),this.y=t.getY(e),this}rotateAround(t,e){const n=Math.cos(e),s=Math.sin(e),r=this.x-t.x,a=this.y-t.y;return this.x=r*n-a*s+t.x,this.y=r*s+a*n+t.y,this}random(){return this.x=Math.random(),this.y=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y}}class ki{constructor(t=0,e=0,n=0,s=1){this.isQuaternion=!0,this._x=t,this._y=e,this._z=n,this._w=s}static slerpFlat(t,e,n,s,r,a,o){let l=n[s+0],c=n[s+1],h=n[s+2],u=n[s+3],f=r[a+0],d=r[a+1],x=r[a+2],v=r[a+3];if(u!==v||l!==f||c!==d||h!==x){let m=l*f+c*d+h*x+u*v;m<0&&(f=-f,d=-d,x=-x,v=-v,m=-m);let p=1-o;if(m<.9995){const S=Math.acos(m),C=Math.sin(S);p=Math.sin(p*S)/C,o=Math.sin(o*S)/C,l=l*p+f*o,c=c*p+d*o,h=h*p+x*o,u=u*p+v*o}else{l=l*p+f*o,c=c*p+d*o,h=h*p+x*o,u=u*p+v*o;const S=1/Math.sqrt(l*l+c*c+h*h+u*u);l*=S,c*=S,h*=S,u*=S}}t[e]=l,t[e+1]=c,t[e+2]=h,t[e+3]=u}static multiplyQuaternionsFlat(t,e,n,s,r,a){const o=n[s],l=n[s+1],c=n[s+2],h=n[s+3],u=r[a],f=r[a+1],d=r[a+2],x=r[a+3];return t[e]=o*x+h*u+l*d-c*f,t[e+1]=l*x+h*f+c*u-o*d,t[e+2]=c*x+h*d+o*f-l*u,t[e+3]=h*x-o*u-l*f-c*d,t}get x(){return this._x}set x(t){this._x=t,this._onChangeCallback()}get y(){return this._y}set y(t){this._y=t,this._onChangeCallback()}get z(){return this._z}set z(t){this._z=t,this._onChangeCallback()}get w(){return this._w}set w(t){this._w=t,this._onChangeCallback()}set(t,e,n,s){return this._x=t,this._y=e,this._z=n,this._w=s,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._w)}copy(t){return this._x=t.x,this._y=t.y,this._z=t.z,this._w=t.w,this._onChangeCallback(),this}setFromEuler(t,e=!0){const n=t._x,s=t._y,r=t._z,a=t._order,o=Math.cos,l=Math.sin,c=o(n/2),h=o(s/2),u=o(r/2),f=l(n/2),d=l(s/2),x=l(r/2);switch(a){case"XYZ":this._x=f*h*u+c*d*x,this._y=c*d*u-f*h*x,this._z=c*h*x+f*d*u,this._w=c*h*u-f*d*x;break;case"YXZ":this._x=f*h*u+c*d*x,this._y=c*d*u-f*h*x,this._z=c*h*x-f*d*u,this._w=c*h*u+f*d*x;break;case"ZXY":this._x=f*h*u-c*d*x,this._y=c*d*u+f*h*x,this._z=c*h*x+f*d*u,this._w=c*h*u-f*d*x;break;case"ZYX":this._x=f*h*u-c*d*x,this._y=c*d*u+f*h*x,this._z=c*h*x-f*d*u,this._w=c*h*u+f*d*x;break;case"YZX":this._x=f*h*u+c*d*x,this._y=c*d*u+f*h*x,this._z=c*h*x-f*d*u,this._w=c*h*u-f*d*x;break;case"XZY":this._x=f*h*u-c*d*x,this._y=c*d*u-f*h*x,this._z=c*h*x+f*d*u,this._w=c*h*u+f*d*x;break;default:Kt("Quaternion: .setFromEuler() encountered an unknown order: "+a)}return e===!0&&this._onChangeCallback(),this}setFromAxisAngle(t,e){const n=e/2,s=Math.sin(n);return this._x=t.x*s,this._y=t.y*s,this._z=t.z*s,this._w=Math.cos(n),this._onChangeCallback(),this}setFromRotationMatrix(t){const e=t.elements,n=e[0],s=e[4],r=e[8],a=e[1],o=e[5],l=e[9],c=e[2],h=e[6],u=e[10],f=n+o+u;if(f>0){const d=.5/Math.sqrt(f+1);this._w=.25/d,this._x=(h-l)*d,this._y=(r-c)*d,this._z=(a-s)*d}else if(n>o&&n>u){const d=2*Math.sqrt(1+n-o-u);this._w=(h-l)/d,this._x=.25*d,this._y=(s+a)/d,this._z=(r+c)/d}else if(o>u){const d=2*Math.sqrt(1+o-n-u);this._w=(r-c)/d,this._x=(s+a)/d,this._y=.25*d,this._z=(l+h)/d}else{const d=2*Math.sqrt(1+u-n-o);this._w=(a-s)/d,this._x=(r+c)/d,this._y=(l+h)/d,this._z=.25*d}return this._onChangeCallback(),this}setFromUnitVectors(t,e){let n=t.dot(e)+1;return n<1e-8?(n=0,Math.abs(t.x)>Math.abs(t.z)?(this._x=-t.y,this._y=t.x,this._z=0,this._w=n):(this._x=0,this._y=-t.z,this._z=t.y,this._w=n)):(this._x=t.y*e.z-t.z*e.y,this._y=t.z*e.x-t.x*e.z,this._z=t.x*e.y-t.y*e.x,this._w=n),this.normalize()}angleTo(t){return 2*Math.acos(Math.abs(fe(this.dot(t),-1,1)))}rotateTowards(t,e){const n=this.angleTo(t);if(n===0)return this;const s=Math.min(1,e/n);return this.slerp(t,s),this}identity(){return this.set(0,0,0,1)}invert(){return this.conjugate()}conjugate(){return this._x*=-1,this._y*=-1,this._z*=-1,this._onChangeCallback(),this}dot(t){return this._x*t._x+this._y*t._y+this._z*t._z+this._w*t._w}lengthSq(){return this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w}length(){return Math.sqrt(this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w)}normalize(){let t=this.length();return t===0?(this._x=0,this._y=0,this._z=0,this._w=1):(t=1/t,this._x=this._x*t,this._y=this._y*t,this._z=this._z*t,this._w=this._w*t),this._onChangeCallback(),this}multiply(t){return this.multiplyQuaternions(this,t)}premultiply(t){return this.multiplyQuaternions(t,this)}multiplyQuaternions(t,e){const n=t._x,s=t._y,r=t._z,a=t._w,o=e._x,l=e._y,c=e._z,h=e._w;return this._x=n*h+a*o+s*c-r*l,this._y=s*h+a*l+r*o-n*c,this._z=r*h+a*c+n*l-s*o,this._w=a*h-n*o-s*l-r*c,this._onChangeCallback(),this}slerp(t,e){let n=t._x,s=t._y,r=t._z,a=t._w,o=this.dot(t);o<0&&(n=-n,s=-s,r=-r,a=-a,o=-o);let l=1-e;if(o<.9995){const c=Math.acos(o),h=Math.sin(c);l=Math.sin(l*c)/h,e=Math.sin(e*c)/h,this._x=this._x*l+n*e,this._y=this._y*l+s*e,this._z=this._z*l+r*e,this._w=this._w*l+a*e,this._onChangeCallback()}else this._x=this._x*l+n*e,this._y=this._y*l+s*e,this._z=this._z*l+r*e,this._w=this._w*l+a*e,this.normalize();return this}slerpQuaternions(t,e,n){return this.copy(t).slerp(e,n)}random(){const t=2*Math.PI*Math.random(),e=2*Math.PI*Math.random(),n=Math.random(),s=Math.sqrt(1-n),r=Math.sqrt(n);return this.set(s*Math.sin(t),s*Math.cos(t),r*Math.sin(e),r*Math.cos(e))}equals(t){return t._x===this._x&&t._y===this._y&&t._z===this._z&&t._w===this._w}fromArray(t,e=0){return this._x=t[e],this._y=t[e+1],this._z=t[e+2],this._w=t[e+3],this._onChangeCallback(),this}toArray(t=[],e=0){return t[e]=this._x,t[e+1]=this._y,t[e+2]=this._z,t[e+3]=this._w,t}fromBufferAttribute(t,e){return this._x=t.getX(e),this._y=t.getY(e),this._z=t.getZ(e),this._w=t.getW(e),this._onChangeCallback(),this}toJSON(){return this.toArray()}_onChange(t){return this._onChangeCallback=t,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._w}}class W{static{this.prototype.isVector3=!0}constructor(t=0,e=0,n=0){this.x=t,this.y=e,this.z=n}set(t,e,n){return n===void 0&&(n=this.z),this.x=t,this.y=e,this.z=n,this}setScalar(t){return this.x=t,this.y=t,this.z=t,this}setX(t){return this.x=t,this}setY(t){return this.y=t,this}setZ(t){return this.z=t,this}setComponent(t,e){switch(t){case 0:this.x=e;break;case 1:this.y=e;break;case 2:this.z=e;break;default:throw new Error("THREE.Vector3: index is out of range: "+t)}return this}getComponent(t){switch(t){case 0:return this.x;case 1:return this.y;case 2:return this.z;default:throw new Error("THREE.Vector3: index is out of range: "+t)}}clone(){return new this.constructor(this.x,this.y,this.z)}copy(t){return this.x=t.x,this.y=t.y,this.z=t.z,this}add(t){return this.x+=t.x,this.y+=t.y,this.z+=t.z,this}addScalar(t){return this.x+=t,this.y+=t,this.z+=t,this}addVectors(t,e){return this.x=t.x+e.x,this.y=t.y+e.y,this.z=t.z+e.z,this}addScaledVector(t,e){return this.x+=t.x*e,this.y+=t.y*e,this.z+=t.z*e,this}sub(t){return this.x-=t.x,this.y-=t.y,this.z-=t.z,this}subScalar(t){return this.x-=t,this.y-=t,this.z-=t,this}subVectors(t,e){return this.x=t.x-e.x,this.y=t.y-e.y,this.z=t.z-e.z,this}multiply(t){return this.x*=t.x,this.y*=t.y,this.z*=t.z,this}multiplyScalar(t){return this.x*=t,this.y*=t,this.z*=t,this}multiplyVectors(t,e){return this.x=t.x*e.x,this.y=t.y*e.y,this.z=t.z*e.z,this}applyEuler(t){return this.applyQuaternion(cf.setFromEuler(t))}applyAxisAngle(t,e){return this.applyQuaternion(cf.setFromAxisAngle(t,e))}applyMatrix3(t){const e=this.x,n=this.y,s=this.z,r=t.elements;return this.x=r[0]*e+r[3]*n+r[6]*s,this.y=r[1]*e+r[4]*n+r[7]*s,this.z=r[2]*e+r[5]*n+r[8]*s,this}applyNormalMatrix(t){return this.applyMatrix3(t).normalize()}applyMatrix4(t){const e=this.x,n=this.y,s=this.z,r=t.elements,a=1/(r[3]*e+r[7]*n+r[11]*s+r[15]);return this.x=(r[0]*e+r[4]*n+r[8]*s+r[12])*a,this.y=(r[1]*e+r[5]*n+r[9]*s+r[13])*a,this.z=(r[2]*e+r[6]*n+r[10]*s+r[14])*a,this}applyQuaternion(t){const e=this.x,n=this.y,s=this.z,r=t.x,a=t.y,o=t.z,l=t.w,c=2*(a*s-o*n),h=2*(o*e-r*s),u=2*(r*n-a*e);return this.x=e+l*c+a*u-o*h,this.y=n+l*h+o*c-r*u,this.z=s+l*u+r*h-a*c,this}project(t){return this.applyMatrix4(t.matrixWorldInverse).applyMatrix4(t.projectionMatrix)}unproject(t){return this.applyMatrix4(t.projectionMatrixInverse).applyMatrix4(t.matrixWorld)}transformDirection(t){const e=this.x,n=this.y,s=this.z,r=t.elements;return this.x=r[0]*e+r[4]*n+r[8]*s,this.y=r[1]*e+r[5]*n+r[9]*s,this.z=r[2]*e+r[6]*n+r[10]*s,this.normalize()}divide(t){return this.x/=t.x,this.y/=t.y,this.z/=t.z,this}divideScalar(t){return this.multiplyScalar(1/t)}min(t){return this.x=Math.min(this.x,t.x),this.y=Math.min(this.y,t.y),this.z=Math.min(this.z,t.z),this}max(t){return this.x=Math.max(this.x,t.x),this.y=Math.max(this.y,t.y),this.z=Math.max(this.z,t.z),this}clamp(t,e){return this.x=fe(this.x,t.x,e.x),this.y=fe(this.y,t.y,e.y),this.z=fe(this.z,t.z,e.z),this}clampScalar(t,e){return this.x=fe(this.x,t,e),this.y=fe(this.y,t,e),this.z=fe(this.z,t,e),this}clampLength(t,e){const n=this.length();return this.divideScalar(n||1).multiplyScalar(fe(n,t,e))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this}dot(t){return this.x*t.x+this.y*t.y+this.z*t.z}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)}normalize(){return this.divideScalar(this.length()||1)}setLength(t){return this.normalize().multiplyScalar(t)}lerp(t,e){return this.x+=(t.x-this.x)*e,this.y+=(t.y-this.y)*e,this.z+=(t.z-this.z)*e,this}lerpVectors(t,e,n){return this.x=t.x+(e.x-t.x)*n,this.y=t.y+(e.y-t.y)*n,this.z=t.z+(e.z-t.z)*n,this}cross(t){return this.crossVectors(this,t)}crossVectors(t,e){const n=t.x,s=t.y,r=t.z,a=e.x,o=e.y,l=e.z;return this.x=s*l-r*o,this.y=r*a-n*l,this.z=n*o-s*a,this}projectOnVector(t){const e=t.lengthSq();if(e===0)return this.set(0,0,0);const n=t.dot(this)/e;return this.copy(t).multiplyScalar(n)}projectOnPlane(t){return wl.copy(this).projectOnVector(t),this.sub(wl)}reflect(t){return this.sub(wl.copy(t).multiplyScalar(2*this.dot(t)))}angleTo(t){const e=Math.sqrt(this.lengthSq()*t.lengthSq());if(e===0)return Math.PI/2;const n=this.dot(t)/e;return Math.acos(fe(n,-1,1))}distanceTo(t){return Math.sqrt(this.distanceToSquared(t))}distanceToSquared(t){const e=this.x-t.x,n=this.y-t.y,s=this.z-t.z;return e*e+n*n+s*s}manhattanDistanceTo(t){return Math.abs(this.x-t.x)+Math.abs(this.y-t.y)+Math.abs(this.z-t.z)}setFromSpherical(t){return this.setFromSphericalCoords(t.radius,t.phi,t.theta)}setFromSphericalCoords(t,e,n){const s=Math.sin(e)*t;return this.x=s*Math.sin(n),this.y=Math.cos(e)*t,this.z=s*Math.cos(n),this}setFromCylindrical(t){return this.setFromCylindricalCoords(t.radius,t.theta,t.y)}setFromCylindricalCoords(t,e,n){return this.x=t*Math.sin(e),this.y=n,this.z=t*Math.cos(e),this}setFromMatrixPosition(t){const e=t.elements;return this.x=e[12],this.y=e[13],this.z=e[14],this}setFromMatrixScale(t){const e=this.setFromMatrixColumn(t,0).length(),n=this.setFromMatrixColumn(t,1).length(),s=this.setFromMatrixColumn(t,2).length();return this.x=e,this.y=n,this.z=s,this}setFromMatrixColumn(t,e){return this.fromArray(t.elements,e*4)}setFromMatrix3Column(t,e){return this.fromArray(t.elements,e*3)}setFromEuler(t){return this.x=t._x,this.y=t._y,this.z=t._z,this}setFromColor(t){return this.x=t.r,this.y=t.g,this.z=t.b,this}equals(t){return t.x===this.x&&t.y===this.y&&t.z===this.z}fromArray(t,e=0){return this.x=t[e],this.y=t[e+1],this.z=t[e+2],this}toArray(t=[],e=0){return t[e]=this.x,t[e+1]=this.y,t[e+2]=this.z,t}fromBufferAttribute(t,e){return this.x=t.getX(e),this.y=t.getY(e),this.z=t.getZ(e),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this}randomDirection(){const t=Math.random()*Math.PI*2,e=Math.random()*2-1,n=Math.sqrt(1-e*e);return this.x=n*Math.cos(t),this.y=e,this.z=n*Math.sin(t),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z}}const wl=new W,cf=new ki;class ne{static{this.prototype.isMatrix3=!0}constructor(t,e,n,s,r,a,o,l,c){this.elements=[1,0,0,0,1,0,0,0,1],t!==void 0&&this.set(t,e,n,s,r,a,o,l,c)}set(t,e,n,s,r,a,o,l,c){const h=this.elements;return h[0]=t,h[1]=s,h[2]=o,h[3]=e,h[4]=r,h[5]=l,h[6]=n,h[7]=a,h[8]=c,this}identity(){return this.set(1,0,0,0,1,0,0,0,1),this}copy(t){const e=this.elements,n=t.elements;return e[0]=n[0],e[1]=n[1],e[2]=n[2],e[3]=n[3],e[4]=n[4],e[5]=n[5],e[6]=n[6],e[7]=n[7],e[8]=n[8],this}extractBasis(t,e,n){return t.setFromMatrix3Column(this,0),e.setFromMatrix3Column(this,1),n.setFromMatrix3Column(this,2),this}setFromMatrix4(t){const e=t.elements;return this.set(e[0],e[4],e[8],e[1],e[5],e[9],e[2],e[6],e[10]),this}multiply(t){return this.multiplyMatrices(this,t)}premultiply(t){return this.multiplyMatrices(t,this)}multiplyMatrices(t,e){const n=t.elements,s=e.elements,r=this.elements,a=n[0],o=n[3],l=n[6],c=n[1],h=n[4],u=n[7],f=n[2],d=n[5],x=n[8],v=s[0],m=s[3],p=s[6],S=s[1],C=s[4],b=s[7],P=s[2],T=s[5],_=s[8];return r[0]=a*v+o*S+l*P,r[3]=a*m+o*C+l*T,r[6]=a*p+o*b+l*_,r[1]=c*v+h*S+u*P,r[4]=c*m+h*C+u*T,r[7]=c*p+h*b+u*_,r[2]=f*v+d*S+x*P,r[5]=f*m+d*C+x*T,r[8]=f*p+d*b+x*_,this}multiplyScalar(t){const e=this.elements;return e[0]*=t,e[3]*=t,e[6]*=t,e[1]*=t,e[4]*=t,e[7]*=t,e[2]*=t,e[5]*=t,e[8]*=t,this}determinant(){const t=this.elements,e=t[0],n=t[1],s=t[2],r=t[3],a=t[4],o=t[5],l=t[6],c=t[7],h=t[8];return e*a*h-e*o*c-n*r*h+n*o*l+s*r*c-s*a*l}invert(){const t=this.elements,e=t[0],n=t[1],s=t[2],r=t[3],a=t[4],o=t[5],l=t[6],c=t[7],h=t[8],u=h*a-o*c,f=o*l-h*r,d=c*r-a*l,x=e*u+n*f+s*d;if(x===0)return this.set(0,0,0,0,0,0,0,0,0);const v=1/x;return t[0]=u*v,t[1]=(s*c-h*n)*v,t[2]=(o*n-s*a)*v,t[3]=f*v,t[4]=(h*e-s*l)*v,t[5]=(s*r-o*e)*v,t[6]=d*v,t[7]=(n*l-c*e)*v,t[8]=(a*e-n*r)*v,this}transpose(){let t;const e=this.elements;return t=e[1],e[1]=e[3],e[3]=t,t=e[2],e[2]=e[6],e[6]=t,t=e[5],e[5]=e[7],e[7]=t,this}getNormalMatrix(t){return this.setFromMatrix4(t).invert().transpose()}transposeIntoArray(t){const e=this.elements;return t[0]=e[0],t[1]=e[3],t[2]=e[6],t[3]=e[1],t[4]=e[4],t[5]=e[7],t[6]=e[2],t[7]=e[5],t[8]=e[8],this}setUvTransform(t,e,n,s,r,a,o){const l=Math.cos(r),c=Math.sin(r);return this.set(n*l,n*c,-n*(l*a+c*o)+a+t,-s*c,s*l,-s*(-c*a+l*o)+o+e,0,0,1),this}scale(t,e){return Eo("Matrix3: .scale() is deprecated. Use .makeScale() instead."),this.premultiply(Tl.makeScale(t,e)),this}rotate(t){return Eo("Matrix3: .rotate() is deprecated. Use .makeRotation() instead."),this.premultiply(Tl.makeRotation(-t)),this}translate(t,e){return Eo("Matrix3: .translate() is deprecated. Use .makeTranslation() instead."),this.premultiply(Tl.makeTranslation(t,e)),this}makeTranslation(t,e){return t.isVector2?this.set(1,0,t.x,0,1,t.y,0,0,1):this.set(1,0,t,0,1,e,0,0,1),this}makeRotation(t){const e=Math.cos(t),n=Math.sin(t);return this.set(e,-n,0,n,e,0,0,0,1),this}makeScale(t,e){return this.set(t,0,0,0,e,0,0,0,1),this}equals(t){const e=this.elements,n=t.elements;for(let s=0;s<9;s++)if(e[s]!==n[s])return!1;return!0}fromArray(t,e=0){for(let n=0;n<9;n++)this.elements[n]=t[n+e];return this}toArray(t=[],e=0){const n=this.elements;return t[e]=n[0],t[e+1]=n[1],t[e+2]=n[2],t[e+3]=n[3],t[e+4]=n[4],t[e+5]=n[5],t[e+6]=n[6],t[e+7]=n[7],t[e+8]=n[8],t}clone(){return new this.constructor().fromArray(this.elements)}}const Tl=new ne,hf=new ne().set(.4123908,.3575843,.1804808,.212639,.7151687,.0721923,.0193308,.1191948,.9505322),uf=new ne().set(3.2409699,-1.5373832,-.4986108,-.9692436,1.8759675,.0415551,.0556301,-.203977,1.0569715);function J0(){const i={enabled:!0,workingColorSpace:Do,spaces:{},convert:function(s,r,a){return this.enabled===!1||r===a||!r||!a||(this.spaces[r].transfer===Ce&&(s.r=is(s.r),s.g=is(s.g),s.b=is(s.b)),this.spaces[r].primaries!==this.spaces[a].primaries&&(s.applyMatrix3(this.spaces[r].toXYZ),s.applyMatrix3(this.spaces[a].fromXYZ)),this.spaces[a].transfer===Ce&&(s.r=br(s.r),s.g=br(s.g),s.b=br(s.b))),s},workingToColorSpace:function(s,r){return this.convert(s,this.workingColorSpace,r)},colorSpaceToWorking:function(s,r){return this.convert(s,r,this.workingColorSpace)},getPrimaries:function(s){return this.spaces[s].primaries},getTransfer:function(s){return s===Ms?No:this.spaces[s].transfer},getToneMappingMode:function(s){return this.spaces[s].outputColorSpaceConfig.toneMappingMode||"standard"},getLuminanceCoefficients:function(s,r=this.workingColorSpace){return s.fromArray(this.spaces[r].luminanceCoefficients)},define:function(s){Object.assign(this.spaces,s)},_getMatrix:function(s,r,a){return s.copy(this.spaces[a].fromXYZ).multiply(this.spaces[r].toXYZ)},_getDrawingBufferColorSpace:function(s){return this.spaces[s].outputColorSpaceConfig.drawingBufferColorSpace},_getUnpackColorSpace:function(s=this.workingColorSpace){return this.spaces[s].workingColorSpaceConfig.unpackColorSpace}},t=[.64,.33,.3,.6,.15,.06],e=[.2126,.7152,.0722],n=[.3127,.329];return i.define({[Do]:{primaries:t,whitePoint:n,transfer:No,toXYZ:hf,fromXYZ:uf,luminanceCoefficients:e,workingColorSpaceConfig:{unpackColorSpace:oi},outputColorSpaceConfig:{drawingBufferColorSpace:oi}},[oi]:{primaries:t,whitePoint:n,transfer:Ce,toXYZ:hf,fromXYZ:uf,luminanceCoefficients:e,outputColorSpaceConfig:{drawingBufferColorSpace:oi}}}),i}const _e=J0();function is(i){return i<.04045?i*.0773993808:Math.pow(i*.9478672986+.0521327014,2.4)}function br(i){return i<.0031308?i*12.92:1.055*Math.pow(i,.41666)-.055}let nr;class Q0{static getDataURL(t,e="image/png"){if(/^data:/i.test(t.src)||typeof HTMLCanvasElement>"u")return t.src;let n;if(t instanceof HTMLCanvasElement)n=t;else{nr===void 0&&(nr=Uo("canvas")),nr.width=t.width,nr.height=t.height;const s=nr.getContext("2d");t instanceof ImageData?s.putImageData(t,0,0):s.drawImage(t,0,0,t.width,t.height),n=nr}return n.toDataURL(e)}static sRGBToLinear(t){if(typeof HTMLImageElement<"u"&&t instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&t instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&t instanceof ImageBitmap){const e=Uo("canvas");e.width=t.width,e.height=t.height;const n=e.getContext("2d");n.drawImage(t,0,0,t.width,t.height);const s=n.getImageData(0,0,t.width,t.height),r=s.data;for(let a=0;a<r.length;a++)r[a]=is(r[a]/255)*255;return n.putImageData(s,0,0),e}else if(t.data){const e=t.data.slice(0);for(let n=0;n<e.length;n++)e instanceof Uint8Array||e instanceof Uint8ClampedArray?e[n]=Math.floor(is(e[n]/255)*255):e[n]=is(e[n]);return{data:e,width:t.width,height:t.height}}else return Kt("ImageUtils.sRGBToLinear(): Unsupported image type. No color space conversion applied."),t}}let j0=0;class bh{constructor(t=null){this.isTextureSource=!0,Object.defineProperty(this,"id",{value:j0++}),this.uuid=Ta(),this.data=t,this.dataReady=!0,this.version=0}getSize(t){const e=this.data;return typeof HTMLVideoElement<"u"&&e instanceof HTMLVideoElement?t.set(e.videoWidth,e.videoHeight,0):typeof VideoFrame<"u"&&e instanceof VideoFrame?t.set(e.displayWidth,e.displayHeight,0):e!==null?t.set(e.width||0,e.height||0,e.depth||0):t.set(0,0,0),t}set needsUpdate(t){t===!0&&this.version++}toJSON(t){const e=t===void 0||typeof t=="string";if(!e&&t.images[this.uuid]!==void 0)return t.images[this.uuid];const n={uuid:this.uuid,url:""},s=this.data;if(s!==null){let r;if(Array.isArray(s)){r=[];for(let a=0,o=s.length;a<o;a++)s[a].isDataTexture?r.push(Al(s[a].image)):r.push(Al(s[a]))}else r=Al(s);n.url=r}return e||(t.images[this.uuid]=n),n}}function Al(i){return typeof HTMLImageElement<"u"&&i instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&i instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&i instanceof ImageBitmap?Q0.getDataURL(i):i.data?{data:Array.from(i.data),width:i.width,height:i.height,type:i.data.constructor.name}:(Kt("Texture: Unable to serialize Texture."),{})}let tx=0;const Rl=new W;class zn extends Ts{constructor(t=zn.DEFAULT_IMAGE,e=zn.DEFAULT_MAPPING,n=ji,s=ji,r=Gn,a=Ss,o=Ni,l=jn,c=zn.DEFAULT_ANISOTROPY,h=Ms){super(),this.isTexture=!0,Object.defineProperty(this,"id",{value:tx++}),this.uuid=Ta(),this.name="",this.source=new bh(t),this.mipmaps=[],this.mapping=e,this.channel=0,this.wrapS=n,this.wrapT=s,this.magFilter=r,this.minFilter=a,this.anisotropy=c,this.format=o,this.internalFormat=null,this.type=l,this.offset=new ee(0,0),this.repeat=new ee(1,1),this.center=new ee(0,0),this.rotation=0,this.matrixAutoUpdate=!0,this.matrix=new ne,this.generateMipmaps=!0,this.mipmapsAutoUpdate=!0,this.premultiplyAlpha=!1,this.flipY=!0,this.unpackAlignment=4,this.colorSpace=h,this.userData={},this.updateRanges=[],this.version=0,this.onUpdate=null,this.renderTarget=null,this.isRenderTargetTexture=!1,this.isArrayTexture=!!(t&&t.depth&&t.depth>1),this.pmremVersion=0,this.isPMREMTexture=!1,this.normalized=!1}get width(){return this.source.getSize(Rl).x}get height(){return this.source.getSize(Rl).y}get depth(){return this.source.getSize(Rl).z}get image(){return this.source.data}set image(t){this.source.data=t}updateMatrix(){this.matrix.setUvTransform(this.offset.x,this.offset.y,this.repeat.x,this.repeat.y,this.rotation,this.center.x,this.center.y)}addUpdateRange(t,e){this.updateRanges.push({start:t,count:e})}clearUpdateRanges(){this.updateRanges.length=0}clone(){return new this.constructor().copy(this)}copy(t){return this.name=t.name,this.source=t.source,this.mipmaps=t.mipmaps.slice(0),this.mapping=t.mapping,this.channel=t.channel,this.wrapS=t.wrapS,this.wrapT=t.wrapT,this.magFilter=t.magFilter,this.minFilter=t.minFilter,this.anisotropy=t.anisotropy,this.format=t.format,this.internalFormat=t.internalFormat,this.type=t.type,this.normalized=t.normalized,this.offset.copy(t.offset),this.repeat.copy(t.repeat),this.center.copy(t.center),this.rotation=t.rotation,this.matrixAutoUpdate=t.matrixAutoUpdate,this.matrix.copy(t.matrix),this.generateMipmaps=t.generateMipmaps,this.mipmapsAutoUpdate=t.mipmapsAutoUpdate,this.premultiplyAlpha=t.premultiplyAlpha,this.flipY=t.flipY,this.unpackAlignment=t.unpackAlignment,this.colorSpace=t.colorSpace,this.renderTarget=t.renderTarget,this.isRenderTargetTexture=t.isRenderTargetTexture,this.isPMREMTexture=t.isPMREMTexture,this.isArrayTexture=t.isArrayTexture,this.userData=JSON.parse(JSON.stringify(t.userData)),this.needsUpdate=!0,this}setValues(t){for(const e in t){const n=t[e];if(n===void 0){Kt(`Texture.setValues(): parameter '${e}' has value of undefined.`);continue}const s=this[e];if(s===void 0){Kt(`Texture.setValues(): property '${e}' does not exist.`);continue}s&&n&&s.isVector2&&n.isVector2||s&&n&&s.isVector3&&n.isVector3||s&&n&&s.isMatrix3&&n.isMatrix3?s.copy(n):this[e]=n}}toJSON(t){const e=t===void 0||typeof t=="string";if(!e&&t.textures[this.uuid]!==void 0)return t.textures[this.uuid];const n={metadata:{version:4.7,type:"Texture",generator:"Texture.toJSON"},uuid:this.uuid,name:this.name,image:this.source.toJSON(t).uuid,mapping:this.mapping,channel:this.channel,repeat:[this.repeat.x,this.repeat.y],offset:[this.offset.x,this.offset.y],center:[this.center.x,this.center.y],rotation:this.rotation,wrap:[this.wrapS,this.wrapT],format:this.format,internalFormat:this.internalFormat,type:this.type,normalized:this.normalized,colorSpace:this.colorSpace,minFilter:this.minFilter,magFilter:this.magFilter,anisotropy:this.anisotropy,flipY:this.flipY,generateMipmaps:this.generateMipmaps,mipmapsAutoUpdate:this.mipmapsAutoUpdate,premultiplyAlpha:this.premultiplyAlpha,unpackAlignment:this.unpackAlignment};return Object.keys(this.userData).length>0&&(n.userData=this.userData),e||(t.textures[this.uuid]=n),n}dispose(){this.dispatchEvent({type:"dispose"})}transformUv(t){if(this.mapping!==mp)return t;if(t.applyMatrix3(this.matrix),t.x<0||t.x>1)switch(this.wrapS){case _c:t.x=t.x-Math.floor(t.x);break;case ji:t.x=t.x<0?0:1;break;case xc:Math.abs(Math.floor(t.x)%2)===1?t.x=Math.ceil(t.x)-t.x:t.x=t.x-Math.floor(t.x);break}if(t.y<0||t.y>1)switch(this.wrapT){case _c:t.y=t.y-Math.floor(t.y);break;case ji:t.y=t.y<0?0:1;break;case xc:Math.abs(Math.floor(t.y)%2)===1?t.y=Math.ceil(t.y)-t.y:t.y=t.y-Math.floor(t.y);break}return this.flipY&&(t.y=1-t.y),t}set needsUpdate(t){t===!0&&(this.version++,this.source.needsUpdate=!0)}set needsPMREMUpdate(t){t===!0&&this.pmremVersion++}}zn.DEFAULT_IMAGE=null;zn.DEFAULT_MAPPING=mp;zn.DEFAULT_ANISOTROPY=1;class je{static{this.prototype.isVector4=!0}constructor(t=0,e=0,n=0,s=1){this.x=t,this.y=e,this.z=n,this.w=s}get width(){return this.z}set width(t){this.z=t}get height(){return this.w}set height(t){this.w=t}set(t,e,n,s){return this.x=t,this.y=e,this.z=n,this.w=s,this}setScalar(t){return this.x=t,this.y=t,this.z=t,this.w=t,this}setX(t){return this.x=t,this}setY(t){return this.y=t,this}setZ(t){return this.z=t,this}setW(t){return this.w=t,this}setComponent(t,e){switch(t){case 0:this.x=e;break;case 1:this.y=e;break;case 2:this.z=e;break;case 3:this.w=e;break;default:throw new Error("THREE.Vector4: index is out of range: "+t)}return this}getComponent(t){switch(t){case 0:return this.x;case 1:return this.y;case 2:return this.z;case 3:return this.w;default:throw new Error("THREE.Vector4: index is out of range: "+t)}}clone(){return new this.constructor(this.x,this.y,this.z,this.w)}copy(t){return this.x=t.x,this.y=t.y,this.z=t.z,this.w=t.w!==void 0?t.w:1,this}add(t){return this.x+=t.x,this.y+=t.y,this.z+=t.z,this.w+=t.w,this}addScalar(t){return this.x+=t,this.y+=t,this.z+=t,this.w+=t,this}addVectors(t,e){return this.x=t.x+e.x,this.y=t.y+e.y,this.z=t.z+e.z,this.w=t.w+e.w,this}addScaledVector(t,e){return this.x+=t.x*e,this.y+=t.y*e,this.z+=t.z*e,this.w+=t.w*e,this}sub(t){return this.x-=t.x,this.y-=t.y,this.z-=t.z,this.w-=t.w,this}subScalar(t){return this.x-=t,this.y-=t,this.z-=t,this.w-=t,this}subVectors(t,e){return this.x=t.x-e.x,this.y=t.y-e.y,this.z=t.z-e.z,this.w=t.w-e.w,this}multiply(t){return this.x*=t.x,this.y*=t.y,this.z*=t.z,this.w*=t.w,this}multiplyScalar(t){return this.x*=t,this.y*=t,this.z*=t,this.w*=t,this}applyMatrix4(t){const e=this.x,n=this.y,s=this.z,r=this.w,a=t.elements;return this.x=a[0]*e+a[4]*n+a[8]*s+a[12]*r,this.y=a[1]*e+a[5]*n+a[9]*s+a[13]*r,this.z=a[2]*e+a[6]*n+a[10]*s+a[14]*r,this.w=a[3]*e+a[7]*n+a[11]*s+a[15]*r,this}divide(t){return this.x/=t.x,this.y/=t.y,this.z/=t.z,this.w/=t.w,this}divideScalar(t){return this.multiplyScalar(1/t)}setAxisAngleFromQuaternion(t){this.w=2*Math.acos(t.w);const e=Math.sqrt(1-t.w*t.w);return e<1e-4?(this.x=1,this.y=0,this.z=0):(this.x=t.x/e,this.y=t.y/e,this.z=t.z/e),this}setAxisAngleFromRotationMatrix(t){let e,n,s,r;const l=t.elements,c=l[0],h=l[4],u=l[8],f=l[1],d=l[5],x=l[9],v=l[2],m=l[6],p=l[10];if(Math.abs(h-f)<.01&&Math.abs(u-v)<.01&&Math.abs(x-m)<.01){if(Math.abs(h+f)<.1&&Math.abs(u+v)<.1&&Math.abs(x+m)<.1&&Math.abs(c+d+p-3)<.1)return this.set(1,0,0,0),this;e=Math.PI;const C=(c+1)/2,b=(d+1)/2,P=(p+1)/2,T=(h+f)/4,_=(u+v)/4,w=(x+m)/4;return C>b&&C>P?C<.01?(n=0,s=.707106781,r=.707106781):(n=Math.sqrt(C),s=T/n,r=_/n):b>P?b<.01?(n=.707106781,s=0,r=.707106781):(s=Math.sqrt(b),n=T/s,r=w/s):P<.01?(n=.707106781,s=.707106781,r=0):(r=Math.sqrt(P),n=_/r,s=w/r),this.set(n,s,r,e),this}let S=Math.sqrt((m-x)*(m-x)+(u-v)*(u-v)+(f-h)*(f-h));return Math.abs(S)<.001&&(S=1),this.x=(m-x)/S,this.y=(u-v)/S,this.z=(f-h)/S,this.w=Math.acos((c+d+p-1)/2),this}setFromMatrixPosition(t){const e=t.elements;return this.x=e[12],this.y=e[13],this.z=e[14],this.w=e[15],this}min(t){return this.x=Math.min(this.x,t.x),this.y=Math.min(this.y,t.y),this.z=Math.min(this.z,t.z),this.w=Math.min(this.w,t.w),this}max(t){return this.x=Math.max(this.x,t.x),this.y=Math.max(this.y,t.y),this.z=Math.max(this.z,t.z),this.w=Math.max(this.w,t.w),this}clamp(t,e){return this.x=fe(this.x,t.x,e.x),this.y=fe(this.y,t.y,e.y),this.z=fe(this.z,t.z,e.z),this.w=fe(this.w,t.w,e.w),this}clampScalar(t,e){return this.x=fe(this.x,t,e),this.y=fe(this.y,t,e),this.z=fe(this.z,t,e),this.w=fe(this.w,t,e),this}clampLength(t,e){const n=this.length();return this.divideScalar(n||1).multiplyScalar(fe(n,t,e))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this.w=Math.floor(this.w),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this.w=Math.ceil(this.w),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this.w=Math.round(this.w),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this.w=Math.trunc(this.w),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this.w=-this.w,this}dot(t){return this.x*t.x+this.y*t.y+this.z*t.z+this.w*t.w}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)+Math.abs(this.w)}normalize(){return this.divideScalar(this.length()||1)}setLength(t){return this.normalize().multiplyScalar(t)}lerp(t,e){return this.x+=(t.x-this.x)*e,this.y+=(t.y-this.y)*e,this.z+=(t.z-this.z)*e,this.w+=(t.w-this.w)*e,this}lerpVectors(t,e,n){return this.x=t.x+(e.x-t.x)*n,this.y=t.y+(e.y-t.y)*n,this.z=t.z+(e.z-t.z)*n,this.w=t.w+(e.w-t.w)*n,this}equals(t){return t.x===this.x&&t.y===this.y&&t.z===this.z&&t.w===this.w}fromArray(t,e=0){return this.x=t[e],this.y=t[e+1],this.z=t[e+2],this.w=t[e+3],this}toArray(t=[],e=0){return t[e]=this.x,t[e+1]=this.y,t[e+2]=this.z,t[e+3]=this.w,t}fromBufferAttribute(t,e){return this.x=t.getX(e),this.y=t.getY(e),this.z=t.getZ(e),this.w=t.getW(e),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this.w=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z,yield this.w}}class ex extends Ts{constructor(t=1,e=1,n={}){super(),n=Object.assign({generateMipmaps:!1,internalFormat:null,minFilter:Gn,depthBuffer:!0,stencilBuffer:!1,resolveColorBuffer:!0,resolveDepthBuffer:!0,resolveStencilBuffer:!0,storeMultisampledColorBuffer:!0,storeMultisampledDepthBuffer:!0,storeMultisampledStencilBuffer:!0,depthTexture:null,samples:0,count:1,depth:1,multiview:!1,useArrayDepthTexture:!1},n),this.isRenderTarget=!0,this.width=t,this.height=e,this.depth=n.depth,this.scissor=new je(0,0,t,e),this.scissorTest=!1,this.viewport=new je(0,0,t,e),this.textures=[];const s=n.count;for(let r=0;r<s;r++)this.textures[r]=new zn({width:t,height:e,depth:n.depth}),this.textures[r].isRenderTargetTexture=!0,this.textures[r].renderTarget=this;this._setTextureOptions(n),this.depthBuffer=n.depthBuffer,this.stencilBuffer=n.stencilBuffer,this.resolveColorBuffer=n.resolveColorBuffer,this.resolveDepthBuffer=n.resolveDepthBuffer,this.resolveStencilBuffer=n.resolveStencilBuffer,this.storeMultisampledColorBuffer=n.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=n.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=n.storeMultisampledStencilBuffer,this._depthTexture=null,this.depthTexture=n.depthTexture,this.samples=n.samples,this.multiview=n.multiview,this.useArrayDepthTexture=n.useArrayDepthTexture}_setTextureOptions(t={}){const e={minFilter:Gn,generateMipmaps:!1,flipY:!1,internalFormat:null};t.mapping!==void 0&&(e.mapping=t.mapping),t.wrapS!==void 0&&(e.wrapS=t.wrapS),t.wrapT!==void 0&&(e.wrapT=t.wrapT),t.wrapR!==void 0&&(e.wrapR=t.wrapR),t.magFilter!==void 0&&(e.magFilter=t.magFilter),t.minFilter!==void 0&&(e.minFilter=t.minFilter),t.format!==void 0&&(e.format=t.format),t.type!==void 0&&(e.type=t.type),t.anisotropy!==void 0&&(e.anisotropy=t.anisotropy),t.colorSpace!==void 0&&(e.colorSpace=t.colorSpace),t.flipY!==void 0&&(e.flipY=t.flipY),t.generateMipmaps!==void 0&&(e.generateMipmaps=t.generateMipmaps),t.mipmapsAutoUpdate!==void 0&&(e.mipmapsAutoUpdate=t.mipmapsAutoUpdate),t.internalFormat!==void 0&&(e.internalFormat=t.internalFormat);for(let n=0;n<this.textures.length;n++)this.textures[n].setValues(e)}get texture(){return this.textures[0]}set texture(t){this.textures[0]=t}set depthTexture(t){this._depthTexture!==null&&this._depthTexture.renderTarget===this&&(this._depthTexture.renderTarget=null),t!==null&&t.renderTarget===null&&(t.renderTarget=this),this._depthTexture=t}get depthTexture(){return this._depthTexture}setSize(t,e,n=1){if(this.width!==t||this.height!==e||this.depth!==n){this.width=t,this.height=e,this.depth=n;for(let s=0,r=this.textures.length;s<r;s++)this.textures[s].image.width=t,this.textures[s].image.height=e,this.textures[s].image.depth=n,this.textures[s].isData3DTexture!==!0&&(this.textures[s].isArrayTexture=this.textures[s].image.depth>1);this.dispose()}this.viewport.set(0,0,t,e),this.scissor.set(0,0,t,e)}clone(){return new this.constructor().copy(this)}copy(t){this.width=t.width,this.height=t.height,this.depth=t.depth,this.scissor.copy(t.scissor),this.scissorTest=t.scissorTest,this.viewport.copy(t.viewport),this.textures.length=0;for(let e=0,n=t.textures.length;e<n;e++){this.textures[e]=t.textures[e].clone(),this.textures[e].isRenderTargetTexture=!0,this.textures[e].renderTarget=this;const s=Object.assign({},t.textures[e].image);this.textures[e].source=new bh(s)}if(this.depthBuffer=t.depthBuffer,this.stencilBuffer=t.stencilBuffer,this.resolveColorBuffer=t.resolveColorBuffer,this.resolveDepthBuffer=t.resolveDepthBuffer,this.resolveStencilBuffer=t.resolveStencilBuffer,this.storeMultisampledColorBuffer=t.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=t.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=t.storeMultisampledStencilBuffer,t.depthTexture!==null)if(t.depthTexture.renderTarget===t){const e=t.depthTexture.clone();e.renderTarget=null,this.depthTexture=e}else this.depthTexture=t.depthTexture;else this.depthTexture=null;return this.samples=t.samples,this.multiview=t.multiview,this.useArrayDepthTexture=t.useArrayDepthTexture,this}dispose(){this.dispatchEvent({type:"dispose"})}}class Ii extends ex{constructor(t=1,e=1,n={}){super(t,e,n),this.isWebGLRenderTarget=!0}}class Tp extends zn{constructor(t=null,e=1,n=1,s=1){super(null),this.isDataArrayTexture=!0,this.image={data:t,width:e,height:n,depth:s},this.magFilter=An,this.minFilter=An,this.wrapR=ji,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1,this.layerUpdates=new Set}copy(t){return super.copy(t),this.wrapR=t.wrapR,this}addLayerUpdate(t){this.layerUpdates.add(t)}clearLayerUpdates(){this.layerUpdates.clear()}}class nx extends zn{constructor(t=null,e=1,n=1,s=1){super(null),this.isData3DTexture=!0,this.image={data:t,width:e,height:n,depth:s},this.magFilter=An,this.minFilter=An,this.wrapR=ji,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}copy(t){return super.copy(t),this.wrapR=t.wrapR,this}}class Pe{static{this.prototype.isMatrix4=!0}constructor(t,e,n,s,r,a,o,l,c,h,u,f,d,x,v,m){this.elements=[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],t!==void 0&&this.set(t,e,n,s,r,a,o,l,c,h,u,f,d,x,v,m)}set(t,e,n,s,r,a,o,l,c,h,u,f,d,x,v,m){const p=this.elements;return p[0]=t,p[4]=e,p[8]=n,p[12]=s,p[1]=r,p[5]=a,p[9]=o,p[13]=l,p[2]=c,p[6]=h,p[10]=u,p[14]=f,p[3]=d,p[7]=x,p[11]=v,p[15]=m,this}identity(){return this.set(1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1),this}clone(){return new Pe().fromArray(this.elements)}copy(t){const e=this.elements,n=t.elements;return e[0]=n[0],e[1]=n[1],e[2]=n[2],e[3]=n[3],e[4]=n[4],e[5]=n[5],e[6]=n[6],e[7]=n[7],e[8]=n[8],e[9]=n[9],e[10]=n[10],e[11]=n[11],e[12]=n[12],e[13]=n[13],e[14]=n[14],e[15]=n[15],this}copyPosition(t){const e=this.elements,n=t.elements;return e[12]=n[12],e[13]=n[13],e[14]=n[14],this}setFromMatrix3(t){const e=t.elements;return this.set(e[0],e[3],e[6],0,e[1],e[4],e[7],0,e[2],e[5],e[8],0,0,0,0,1),this}extractBasis(t,e,n){return this.determinantAffine()===0?(t.set(1,0,0),e.set(0,1,0),n.set(0,0,1),this):(t.setFromMatrixColumn(this,0),e.setFromMatrixColumn(this,1),n.setFromMatrixColumn(this,2),this)}makeBasis(t,e,n){return this.set(t.x,e.x,n.x,0,t.y,e.y,n.y,0,t.z,e.z,n.z,0,0,0,0,1),this}extractRotation(t){if(t.determinantAffine()===0)return this.identity();const e=this.elements,n=t.elements,s=1/ir.setFromMatrixColumn(t,0).length(),r=1/ir.setFromMatrixColumn(t,1).length(),a=1/ir.setFromMatrixColumn(t,2).length();return e[0]=n[0]*s,e[1]=n[1]*s,e[2]=n[2]*s,e[3]=0,e[4]=n[4]*r,e[5]=n[5]*r,e[6]=n[6]*r,e[7]=0,e[8]=n[8]*a,e[9]=n[9]*a,e[10]=n[10]*a,e[11]=0,e[12]=0,e[13]=0,e[14]=0,e[15]=1,this}makeRotationFromEuler(t){const e=this.elements,n=t.x,s=t.y,r=t.z,a=Math.cos(n),o=Math.sin(n),l=Math.cos(s),c=Math.sin(s),h=Math.cos(r),u=Math.sin(r);if(t.order==="XYZ"){const f=a*h,d=a*u,x=o*h,v=o*u;e[0]=l*h,e[4]=-l*u,e[8]=c,e[1]=d+x*c,e[5]=f-v*c,e[9]=-o*l,e[2]=v-f*c,e[6]=x+d*c,e[10]=a*l}else if(t.order==="YXZ"){const f=l*h,d=l*u,x=c*h,v=c*u;e[0]=f+v*o,e[4]=x*o-d,e[8]=a*c,e[1]=a*u,e[5]=a*h,e[9]=-o,e[2]=d*o-x,e[6]=v+f*o,e[10]=a*l}else if(t.order==="ZXY"){const f=l*h,d=l*u,x=c*h,v=c*u;e[0]=f-v*o,e[4]=-a*u,e[8]=x+d*o,e[1]=d+x*o,e[5]=a*h,e[9]=v-f*o,e[2]=-a*c,e[6]=o,e[10]=a*l}else if(t.order==="ZYX"){const f=a*h,d=a*u,x=o*h,v=o*u;e[0]=l*h,e[4]=x*c-d,e[8]=f*c+v,e[1]=l*u,e[5]=v*c+f,e[9]=d*c-x,e[2]=-c,e[6]=o*l,e[10]=a*l}else if(t.order==="YZX"){const f=a*l,d=a*c,x=o*l,v=o*c;e[0]=l*h,e[4]=v-f*u,e[8]=x*u+d,e[1]=u,e[5]=a*h,e[9]=-o*h,e[2]=-c*h,e[6]=d*u+x,e[10]=f-v*u}else if(t.order==="XZY"){const f=a*l,d=a*c,x=o*l,v=o*c;e[0]=l*h,e[4]=-u,e[8]=c*h,e[1]=f*u+v,e[5]=a*h,e[9]=d*u-x,e[2]=x*u-d,e[6]=o*h,e[10]=v*u+f}return e[3]=0,e[7]=0,e[11]=0,e[12]=0,e[13]=0,e[14]=0,e[15]=1,this}makeRotationFromQuaternion(t){return this.compose(ix,t,sx)}lookAt(t,e,n){const s=this.elements;return Zn.subVectors(t,e),Zn.lengthSq()===0&&(Zn.z=1),Zn.normalize(),fs.crossVectors(n,Zn),fs.lengthSq()===0&&(Math.abs(n.z)===1?Zn.x+=1e-4:Zn.z+=1e-4,Zn.normalize(),fs.crossVectors(n,Zn)),fs.normalize(),Ha.crossVectors(Zn,fs),s[0]=fs.x,s[4]=Ha.x,s[8]=Zn.x,s[1]=fs.y,s[5]=Ha.y,s[9]=Zn.y,s[2]=fs.z,s[6]=Ha.z,s[10]=Zn.z,this}multiply(t){return this.multiplyMatrices(this,t)}premultiply(t){return this.multiplyMatrices(t,this)}multiplyMatrices(t,e){const n=t.elements,s=e.elements,r=this.elements,a=n[0],o=n[4],l=n[8],c=n[12],h=n[1],u=n[5],f=n[9],d=n[13],x=n[2],v=n[6],m=n[10],p=n[14],S=n[3],C=n[7],b=n[11],P=n[15],T=s[0],_=s[4],w=s[8],B=s[12],I=s[1],D=s[5],z=s[9],V=s[13],N=s[2],H=s[6],K=s[10],k=s[14],lt=s[3],Z=s[7],Q=s[11],it=s[15];return r[0]=a*T+o*I+l*N+c*lt,r[4]=a*_+o*D+l*H+c*Z,r[8]=a*w+o*z+l*K+c*Q,r[12]=a*B+o*V+l*k+c*it,r[1]=h*T+u*I+f*N+d*lt,r[5]=h*_+u*D+f*H+d*Z,r[9]=h*w+u*z+f*K+d*Q,r[13]=h*B+u*V+f*k+d*it,r[2]=x*T+v*I+m*N+p*lt,r[6]=x*_+v*D+m*H+p*Z,r[10]=x*w+v*z+m*K+p*Q,r[14]=x*B+v*V+m*k+p*it,r[3]=S*T+C*I+b*N+P*lt,r[7]=S*_+C*D+b*H+P*Z,r[11]=S*w+C*z+b*K+P*Q,r[15]=S*B+C*V+b*k+P*it,this}multiplyScalar(t){const e=this.elements;return e[0]*=t,e[4]*=t,e[8]*=t,e[12]*=t,e[1]*=t,e[5]*=t,e[9]*=t,e[13]*=t,e[2]*=t,e[6]*=t,e[10]*=t,e[14]*=t,e[3]*=t,e[7]*=t,e[11]*=t,e[15]*=t,this}determinant(){const t=this.elements,e=t[0],n=t[4],s=t[8],r=t[12],a=t[1],o=t[5],l=t[9],c=t[13],h=t[2],u=t[6],f=t[10],d=t[14],x=t[3],v=t[7],m=t[11],p=t[15],S=l*d-c*f,C=o*d-c*u,b=o*f-l*u,P=a*d-c*h,T=a*f-l*h,_=a*u-o*h;return e*(v*S-m*C+p*b)-n*(x*S-m*P+p*T)+s*(x*C-v*P+p*_)-r*(x*b-v*T+m*_)}determinantAffine(){const t=this.elements,e=t[0],n=t[4],s=t[8],r=t[1],a=t[5],o=t[9],l=t[2],c=t[6],h=t[10];return e*(a*h-o*c)-n*(r*h-o*l)+s*(r*c-a*l)}transpose(){const t=this.elements;let e;return e=t[1],t[1]=t[4],t[4]=e,e=t[2],t[2]=t[8],t[8]=e,e=t[6],t[6]=t[9],t[9]=e,e=t[3],t[3]=t[12],t[12]=e,e=t[7],t[7]=t[13],t[13]=e,e=t[11],t[11]=t[14],t[14]=e,this}setPosition(t,e,n){const s=this.elements;return t.isVector3?(s[12]=t.x,s[13]=t.y,s[14]=t.z):(s[12]=t,s[13]=e,s[14]=n),this}invert(){const t=this.elements,e=t[0],n=t[1],s=t[2],r=t[3],a=t[4],o=t[5],l=t[6],c=t[7],h=t[8],u=t[9],f=t[10],d=t[11],x=t[12],v=t[13],m=t[14],p=t[15],S=e*o-n*a,C=e*l-s*a,b=e*c-r*a,P=n*l-s*o,T=n*c-r*o,_=s*c-r*l,w=h*v-u*x,B=h*m-f*x,I=h*p-d*x,D=u*m-f*v,z=u*p-d*v,V=f*p-d*m,N=S*V-C*z+b*D+P*I-T*B+_*w;if(N===0)return this.set(0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0);const H=1/N;return t[0]=(o*V-l*z+c*D)*H,t[1]=(s*z-n*V-r*D)*H,t[2]=(v*_-m*T+p*P)*H,t[3]=(f*T-u*_-d*P)*H,t[4]=(l*I-a*V-c*B)*H,t[5]=(e*V-s*I+r*B)*H,t[6]=(m*b-x*_-p*C)*H,t[7]=(h*_-f*b+d*C)*H,t[8]=(a*z-o*I+c*w)*H,t[9]=(n*I-e*z-r*w)*H,t[10]=(x*T-v*b+p*S)*H,t[11]=(u*b-h*T-d*S)*H,t[12]=(o*B-a*D-l*w)*H,t[13]=(e*D-n*B+s*w)*H,t[14]=(v*C-x*P-m*S)*H,t[15]=(h*P-u*C+f*S)*H,this}scale(t){const e=this.elements,n=t.x,s=t.y,r=t.z;return e[0]*=n,e[4]*=s,e[8]*=r,e[1]*=n,e[5]*=s,e[9]*=r,e[2]*=n,e[6]*=s,e[10]*=r,e[3]*=n,e[7]*=s,e[11]*=r,this}getMaxScaleOnAxis(){const t=this.elements,e=t[0]*t[0]+t[1]*t[1]+t[2]*t[2],n=t[4]*t[4]+t[5]*t[5]+t[6]*t[6],s=t[8]*t[8]+t[9]*t[9]+t[10]*t[10];return Math.sqrt(Math.max(e,n,s))}makeTranslation(t,e,n){return t.isVector3?this.set(1,0,0,t.x,0,1,0,t.y,0,0,1,t.z,0,0,0,1):this.set(1,0,0,t,0,1,0,e,0,0,1,n,0,0,0,1),this}makeRotationX(t){const e=Math.cos(t),n=Math.sin(t);return this.set(1,0,0,0,0,e,-n,0,0,n,e,0,0,0,0,1),this}makeRotationY(t){const e=Math.cos(t),n=Math.sin(t);return this.set(e,0,n,0,0,1,0,0,-n,0,e,0,0,0,0,1),this}makeRotationZ(t){const e=Math.cos(t),n=Math.sin(t);return this.set(e,-n,0,0,n,e,0,0,0,0,1,0,0,0,0,1),this}makeRotationAxis(t,e){const n=Math.cos(e),s=Math.sin(e),r=1-n,a=t.x,o=t.y,l=t.z,c=r*a,h=r*o;return this.set(c*a+n,c*o-s*l,c*l+s*o,0,c*o+s*l,h*o+n,h*l-s*a,0,c*l-s*o,h*l+s*a,r*l*l+n,0,0,0,0,1),this}makeScale(t,e,n){return this.set(t,0,0,0,0,e,0,0,0,0,n,0,0,0,0,1),this}makeShear(t,e,n,s,r,a){return this.set(1,n,r,0,t,1,a,0,e,s,1,0,0,0,0,1),this}compose(t,e,n){const s=this.elements,r=e._x,a=e._y,o=e._z,l=e._w,c=r+r,h=a+a,u=o+o,f=r*c,d=r*h,x=r*u,v=a*h,m=a*u,p=o*u,S=l*c,C=l*h,b=l*u,P=n.x,T=n.y,_=n.z;return s[0]=(1-(v+p))*P,s[1]=(d+b)*P,s[2]=(x-C)*P,s[3]=0,s[4]=(d-b)*T,s[5]=(1-(f+p))*T,s[6]=(m+S)*T,s[7]=0,s[8]=(x+C)*_,s[9]=(m-S)*_,s[10]=(1-(f+v))*_,s[11]=0,s[12]=t.x,s[13]=t.y,s[14]=t.z,s[15]=1,this}decompose(t,e,n){const s=this.elements;t.x=s[12],t.y=s[13],t.z=s[14];const r=this.determinantAffine();if(r===0)return n.set(1,1,1),e.identity(),this;let a=ir.set(s[0],s[1],s[2]).length();const o=ir.set(s[4],s[5],s[6]).length(),l=ir.set(s[8],s[9],s[10]).length();r<0&&(a=-a),fi.copy(this);const c=1/a,h=1/o,u=1/l;return fi.elements[0]*=c,fi.elements[1]*=c,fi.elements[2]*=c,fi.elements[4]*=h,fi.elements[5]*=h,fi.elements[6]*=h,fi.elements[8]*=u,fi.elements[9]*=u,fi.elements[10]*=u,e.setFromRotationMatrix(fi),n.x=a,n.y=o,n.z=l,this}makePerspective(t,e,n,s,r,a,o=Si,l=!1){const c=this.elements,h=2*r/(e-t),u=2*r/(n-s),f=(e+t)/(e-t),d=(n+s)/(n-s);let x,v;if(l)x=r/(a-r),v=a*r/(a-r);else if(o===Si)x=-(a+r)/(a-r),v=-2*a*r/(a-r);else if(o===ba)x=-a/(a-r),v=-a*r/(a-r);else throw new Error("THREE.Matrix4.makePerspective(): Invalid coordinate system: "+o);return c[0]=h,c[4]=0,c[8]=f,c[12]=0,c[1]=0,c[5]=u,c[9]=d,c[13]=0,c[2]=0,c[6]=0,c[10]=x,c[14]=v,c[3]=0,c[7]=0,c[11]=-1,c[15]=0,this}makeOrthographic(t,e,n,s,r,a,o=Si,l=!1){const c=this.elements,h=2/(e-t),u=2/(n-s),f=-(e+t)/(e-t),d=-(n+s)/(n-s);let x,v;if(l)x=1/(a-r),v=a/(a-r);else if(o===Si)x=-2/(a-r),v=-(a+r)/(a-r);else if(o===ba)x=-1/(a-r),v=-r/(a-r);else throw new Error("THREE.Matrix4.makeOrthographic(): Invalid coordinate system: "+o);return c[0]=h,c[4]=0,c[8]=0,c[12]=f,c[1]=0,c[5]=u,c[9]=0,c[13]=d,c[2]=0,c[6]=0,c[10]=x,c[14]=v,c[3]=0,c[7]=0,c[11]=0,c[15]=1,this}equals(t){const e=this.elements,n=t.elements;for(let s=0;s<16;s++)if(e[s]!==n[s])return!1;return!0}fromArray(t,e=0){for(let n=0;n<16;n++)this.elements[n]=t[n+e];return this}toArray(t=[],e=0){const n=this.elements;return t[e]=n[0],t[e+1]=n[1],t[e+2]=n[2],t[e+3]=n[3],t[e+4]=n[4],t[e+5]=n[5],t[e+6]=n[6],t[e+7]=n[7],t[e+8]=n[8],t[e+9]=n[9],t[e+10]=n[10],t[e+11]=n[11],t[e+12]=n[12],t[e+13]=n[13],t[e+14]=n[14],t[e+15]=n[15],t}}const ir=new W,fi=new Pe,ix=new W(0,0,0),sx=new W(1,1,1),fs=new W,Ha=new W,Zn=new W,ff=new Pe,df=new ki;class ws{constructor(t=0,e=0,n=0,s=ws.DEFAULT_ORDER){this.isEuler=!0,this._x=t,this._y=e,this._z=n,this._order=s}get x(){return this._x}set x(t){this._x=t,this._onChangeCallback()}get y(){return this._y}set y(t){this._y=t,this._onChangeCallback()}get z(){return this._z}set z(t){this._z=t,this._onChangeCallback()}get order(){return this._order}set order(t){this._order=t,this._onChangeCallback()}set(t,e,n,s=this._order){return this._x=t,this._y=e,this._z=n,this._order=s,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._order)}copy(t){return this._x=t._x,this._y=t._y,this._z=t._z,this._order=t._order,this._onChangeCallback(),this}setFromRotationMatrix(t,e=this._order,n=!0){const s=t.elements,r=s[0],a=s[4],o=s[8],l=s[1],c=s[5],h=s[9],u=s[2],f=s[6],d=s[10];switch(e){case"XYZ":this._y=Math.asin(fe(o,-1,1)),Math.abs(o)<.9999999?(this._x=Math.atan2(-h,d),this._z=Math.atan2(-a,r)):(this._x=Math.atan2(f,c),this._z=0);break;case"YXZ":this._x=Math.asin(-fe(h,-1,1)),Math.abs(h)<.9999999?(this._y=Math.atan2(o,d),this._z=Math.atan2(l,c)):(this._y=Math.atan2(-u,r),this._z=0);break;case"ZXY":this._x=Math.asin(fe(f,-1,1)),Math.abs(f)<.9999999?(this._y=Math.atan2(-u,d),this._z=Math.atan2(-a,c)):(this._y=0,this._z=Math.atan2(l,r));break;case"ZYX":this._y=Math.asin(-fe(u,-1,1)),Math.abs(u)<.9999999?(this._x=Math.atan2(f,d),this._z=Math.atan2(l,r)):(this._x=0,this._z=Math.atan2(-a,c));break;case"YZX":this._z=Math.asin(fe(l,-1,1)),Math.abs(l)<.9999999?(this._x=Math.atan2(-h,c),this._y=Math.atan2(-u,r)):(this._x=0,this._y=Math.atan2(o,d));break;case"XZY":this._z=Math.asin(-fe(a,-1,1)),Math.abs(a)<.9999999?(this._x=Math.atan2(f,c),this._y=Math.atan2(o,r)):(this._x=Math.atan2(-h,d),this._y=0);break;default:Kt("Euler: .setFromRotationMatrix() encountered an unknown order: "+e)}return this._order=e,n===!0&&this._onChangeCallback(),this}setFromQuaternion(t,e,n){return ff.makeRotationFromQuaternion(t),this.setFromRotationMatrix(ff,e,n)}setFromVector3(t,e=this._order){return this.set(t.x,t.y,t.z,e)}reorder(t){return df.setFromEuler(this),this.setFromQuaternion(df,t)}equals(t){return t._x===this._x&&t._y===this._y&&t._z===this._z&&t._order===this._order}fromArray(t){return this._x=t[0],this._y=t[1],this._z=t[2],t[3]!==void 0&&(this._order=t[3]),this._onChangeCallback(),this}toArray(t=[],e=0){return t[e]=this._x,t[e+1]=this._y,t[e+2]=this._z,t[e+3]=this._order,t}_onChange(t){return this._onChangeCallback=t,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._order}}ws.DEFAULT_ORDER="XYZ";class Ap{constructor(){this.mask=1}set(t){this.mask=(1<<t|0)>>>0}enable(t){this.mask|=1<<t|0}enableAll(){this.mask=-1}toggle(t){this.mask^=1<<t|0}disable(t){this.mask&=~(1<<t|0)}disableAll(){this.mask=0}test(t){return(this.mask&t.mask)!==0}isEnabled(t){return(this.mask&(1<<t|0))!==0}}let rx=0;const pf=new W,sr=new ki,Wi=new Pe,Ga=new W,jr=new W,ax=new W,ox=new ki,mf=new W(1,0,0),gf=new W(0,1,0),_f=new W(0,0,1),xf={type:"added"},lx={type:"removed"},rr={type:"childadded",child:null},Cl={type:"childremoved",child:null};class bn extends Ts{constructor(){super(),this.isObject3D=!0,Object.defineProperty(this,"id",{value:rx++}),this.uuid=Ta(),this.name="",this.type="Object3D",this.parent=null,this.children=[],this.up=bn.DEFAULT_UP.clone();const t=new W,e=new ws,n=new ki,s=new W(1,1,1);function r(){n.setFromEuler(e,!1)}function a(){e.setFromQuaternion(n,void 0,!1)}e._onChange(r),n._onChange(a),Object.defineProperties(this,{position:{configurable:!0,enumerable:!0,value:t},rotation:{configurable:!0,enumerable:!0,value:e},quaternion:{configurable:!0,enumerable:!0,value:n},scale:{configurable:!0,enumerable:!0,value:s},modelViewMatrix:{value:new Pe},normalMatrix:{value:new ne}}),this.matrix=new Pe,this.matrixWorld=new Pe,this.matrixAutoUpdate=bn.DEFAULT_MATRIX_AUTO_UPDATE,this.matrixWorldAutoUpdate=bn.DEFAULT_MATRIX_WORLD_AUTO_UPDATE,this.matrixWorldNeedsUpdate=!1,this.layers=new Ap,this.visible=!0,this.castShadow=!1,this.receiveShadow=!1,this.frustumCulled=!0,this.renderOrder=0,this.animations=[],this.customDepthMaterial=void 0,this.customDistanceMaterial=void 0,this.static=!1,this.userData={},this.pivot=null}onBeforeShadow(){}onAfterShadow(){}onBeforeRender(){}onAfterRender(){}applyMatrix4(t){this.matrixAutoUpdate&&this.updateMatrix(),this.matrix.premultiply(t),this.matrix.decompose(this.position,this.quaternion,this.scale),this.pivot!==null&&this.position.copy(this.pivot).applyMatrix4(this.matrix).sub(this.pivot)}applyQuaternion(t){return this.quaternion.premultiply(t),this}setRotationFromAxisAngle(t,e){this.quaternion.setFromAxisAngle(t,e)}setRotationFromEuler(t){this.quaternion.setFromEuler(t,!0)}setRotationFromMatrix(t){this.quaternion.setFromRotationMatrix(t)}setRotationFromQuaternion(t){this.quaternion.copy(t)}rotateOnAxis(t,e){return sr.setFromAxisAngle(t,e),this.quaternion.multiply(sr),this}rotateOnWorldAxis(t,e){return sr.setFromAxisAngle(t,e),this.quaternion.premultiply(sr),this}rotateX(t){return this.rotateOnAxis(mf,t)}rotateY(t){return this.rotateOnAxis(gf,t)}rotateZ(t){return this.rotateOnAxis(_f,t)}translateOnAxis(t,e){return pf.copy(t).applyQuaternion(this.quaternion),this.position.add(pf.multiplyScalar(e)),this}translateX(t){return this.translateOnAxis(mf,t)}translateY(t){return this.translateOnAxis(gf,t)}translateZ(t){return this.translateOnAxis(_f,t)}localToWorld(t){return this.updateWorldMatrix(!0,!1),t.applyMatrix4(this.matrixWorld)}worldToLocal(t){return this.updateWorldMatrix(!0,!1),t.applyMatrix4(Wi.copy(this.matrixWorld).invert())}lookAt(t,e,n){t.isVector3?Ga.copy(t):Ga.set(t,e,n);const s=this.parent;this.updateWorldMatrix(!0,!1),jr.setFromMatrixPosition(this.matrixWorld),this.isCamera||this.isLight?Wi.lookAt(jr,Ga,this.up):Wi.lookAt(Ga,jr,this.up),this.quaternion.setFromRotationMatrix(Wi),s&&(Wi.extractRotation(s.matrixWorld),sr.setFromRotationMatrix(Wi),this.quaternion.premultiply(sr.invert()))}add(t){if(arguments.length>1){for(let e=0;e<arguments.length;e++)this.add(arguments[e]);return this}return t===this?(Ee("Object3D.add: object can't be added as a child of itself.",t),this):(t&&t.isObject3D?(t.removeFromParent(),t.parent=this,this.children.push(t),t.dispatchEvent(xf),rr.child=t,this.dispatchEvent(rr),rr.child=null):Ee("Object3D.add: object not an instance of THREE.Object3D.",t),this)}remove(t){if(arguments.length>1){for(let n=0;n<arguments.length;n++)this.remove(arguments[n]);return this}const e=this.children.indexOf(t);return e!==-1&&(t.parent=null,this.children.splice(e,1),t.dispatchEvent(lx),Cl.child=t,this.dispatchEvent(Cl),Cl.child=null),this}removeFromParent(){const t=this.parent;return t!==null&&t.remove(this),this}clear(){return this.remove(...this.children)}attach(t){return this.updateWorldMatrix(!0,!1),Wi.copy(this.matrixWorld).invert(),t.parent!==null&&(t.parent.updateWorldMatrix(!0,!1),Wi.multiply(t.parent.matrixWorld)),t.applyMatrix4(Wi),t.removeFromParent(),t.parent=this,this.children.push(t),t.updateWorldMatrix(!1,!0),t.dispatchEvent(xf),rr.child=t,this.dispatchEvent(rr),rr.child=null,this}getObjectById(t){return this.getObjectByProperty("id",t)}getObjectByName(t){return this.getObjectByProperty("name",t)}getObjectByProperty(t,e){if(this[t]===e)return this;for(let n=0,s=this.children.length;n<s;n++){const a=this.children[n].getObjectByProperty(t,e);if(a!==void 0)return a}}getObjectsByProperty(t,e,n=[]){this[t]===e&&n.push(this);const s=this.children;for(let r=0,a=s.length;r<a;r++)s[r].getObjectsByProperty(t,e,n);return n}getWorldPosition(t){return this.updateWorldMatrix(!0,!1),t.setFromMatrixPosition(this.matrixWorld)}getWorldQuaternion(t){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(jr,t,ax),t}getWorldScale(t){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(jr,ox,t),t}getWorldDirection(t){this.updateWorldMatrix(!0,!1);const e=this.matrixWorld.elements;return t.set(e[8],e[9],e[10]).normalize()}raycast(){}intersectsFrustum(){return!0}traverse(t){t(this);const e=this.children;for(let n=0,s=e.length;n<s;n++)e[n].traverse(t)}traverseVisible(t){if(this.visible===!1)return;t(this);const e=this.children;for(let n=0,s=e.length;n<s;n++)e[n].traverseVisible(t)}traverseAncestors(t){const e=this.parent;e!==null&&(t(e),e.traverseAncestors(t))}updateMatrix(){this.matrix.compose(this.position,this.quaternion,this.scale);const t=this.pivot;if(t!==null){const e=t.x,n=t.y,s=t.z,r=this.matrix.elements;r[12]+=e-r[0]*e-r[4]*n-r[8]*s,r[13]+=n-r[1]*e-r[5]*n-r[9]*s,r[14]+=s-r[2]*e-r[6]*n-r[10]*s}this.matrixWorldNeedsUpdate=!0}updateMatrixWorld(t){this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||t)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,t=!0);const e=this.children;for(let n=0,s=e.length;n<s;n++)e[n].updateMatrixWorld(t)}updateWorldMatrix(t,e,n=!1){const s=this.parent;if(t===!0&&s!==null&&s.updateWorldMatrix(!0,!1),this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||n)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,n=!0),e===!0){const r=this.children;for(let a=0,o=r.length;a<o;a++)r[a].updateWorldMatrix(!1,!0,n)}}toJSON(t){const e=t===void 0||typeof t=="string",n={};e&&(t={geometries:{},materials:{},textures:{},images:{},shapes:{},skeletons:{},animations:{},nodes:{}},n.metadata={version:4.7,type:"Object",generator:"Object3D.toJSON"});const s={};s.uuid=this.uuid,s.type=this.type,s.name=this.name,s.castShadow=this.castShadow,s.receiveShadow=this.receiveShadow,s.visible=this.visible,s.frustumCulled=this.frustumCulled,s.renderOrder=this.renderOrder,s.static=this.static,s.matrixAutoUpdate=this.matrixAutoUpdate,Object.keys(this.userData).length>0&&(s.userData=this.userData),s.layers=this.layers.mask,s.matrix=this.matrix.toArray(),s.up=this.up.toArray(),this.pivot!==null&&(s.pivot=this.pivot.toArray()),this.morphTargetDictionary!==void 0&&(s.morphTargetDictionary=Object.assign({},this.morphTargetDictionary)),this.morphTargetInfluences!==void 0&&(s.morphTargetInfluences=this.morphTargetInfluences.slice()),this.isInstancedMesh&&(s.type="InstancedMesh",s.count=this.count,s.instanceMatrix=this.instanceMatrix.toJSON(),this.instanceColor!==null&&(s.instanceColor=this.instanceColor.toJSON())),this.isBatchedMesh&&(s.type="BatchedMesh",s.perObjectFrustumCulled=this.perObjectFrustumCulled,s.sortObjects=this.sortObjects,s.drawRanges=this._drawRanges,s.reservedRanges=this._reservedRanges,s.geometryInfo=this._geometryInfo.map(o=>({...o,boundingBox:o.boundingBox?o.boundingBox.toJSON():void 0,boundingSphere:o.boundingSphere?o.boundingSphere.toJSON():void 0})),s.instanceInfo=this._instanceInfo.map(o=>({...o})),s.availableInstanceIds=this._availableInstanceIds.slice(),s.availableGeometryIds=this._availableGeometryIds.slice(),s.nextIndexStart=this._nextIndexStart,s.nextVertexStart=this._nextVertexStart,s.geometryCount=this._geometryCount,s.maxInstanceCount=this._maxInstanceCount,s.maxVertexCount=this._maxVertexCount,s.maxIndexCount=this._maxIndexCount,s.geometryInitialized=this._geometryInitialized,s.matricesTexture=this._matricesTexture.toJSON(t),s.indirectTexture=this._indirectTexture.toJSON(t),this._colorsTexture!==null&&(s.colorsTexture=this._colorsTexture.toJSON(t)),this.boundingSphere!==null&&(s.boundingSphere=this.boundingSphere.toJSON()),this.boundingBox!==null&&(s.boundingBox=this.boundingBox.toJSON()));function r(o,l){return o[l.uuid]===void 0&&(o[l.uuid]=l.toJSON(t)),l.uuid}if(this.isScene)this.background&&(this.background.isColor?s.background=this.background.toJSON():this.background.isTexture&&(s.background=this.background.toJSON(t).uuid)),this.environment&&this.environment.isTexture&&this.environment.isRenderTargetTexture!==!0&&(s.environment=this.environment.toJSON(t).uuid);else if(this.isMesh||this.isLine||this.isPoints){s.geometry=r(t.geometries,this.geometry);const o=this.geometry.parameters;if(o!==void 0&&o.shapes!==void 0){const l=o.shapes;if(Array.isArray(l))for(let c=0,h=l.length;c<h;c++){const u=l[c];r(t.shapes,u)}else r(t.shapes,l)}}if(this.isSkinnedMesh&&(s.bindMode=this.bindMode,s.bindMatrix=this.bindMatrix.toArray(),this.skeleton!==void 0&&(r(t.skeletons,this.skeleton),s.skeleton=this.skeleton.uuid)),this.material!==void 0)if(Array.isArray(this.material)){const o=[];for(let l=0,c=this.material.length;l<c;l++)o.push(r(t.materials,this.material[l]));s.material=o}else s.material=r(t.materials,this.material);if(this.children.length>0){s.children=[];for(let o=0;o<this.children.length;o++)s.children.push(this.children[o].toJSON(t).object)}if(this.animations.length>0){s.animations=[];for(let o=0;o<this.animations.length;o++){const l=this.animations[o];s.animations.push(r(t.animations,l))}}if(e){const o=a(t.geometries),l=a(t.materials),c=a(t.textures),h=a(t.images),u=a(t.shapes),f=a(t.skeletons),d=a(t.animations),x=a(t.nodes);o.length>0&&(n.geometries=o),l.length>0&&(n.materials=l),c.length>0&&(n.textures=c),h.length>0&&(n.images=h),u.length>0&&(n.shapes=u),f.length>0&&(n.skeletons=f),d.length>0&&(n.animations=d),x.length>0&&(n.nodes=x)}return n.object=s,n;function a(o){const l=[];for(const c in o){const h=o[c];delete h.metadata,l.push(h)}return l}}clone(t){return new this.constructor().copy(this,t)}copy(t,e=!0){if(this.name=t.name,this.up.copy(t.up),this.position.copy(t.position),this.rotation.order=t.rotation.order,this.quaternion.copy(t.quaternion),this.scale.copy(t.scale),this.pivot=t.pivot!==null?t.pivot.clone():null,this.matrix.copy(t.matrix),this.matrixWorld.copy(t.matrixWorld),this.matrixAutoUpdate=t.matrixAutoUpdate,this.matrixWorldAutoUpdate=t.matrixWorldAutoUpdate,this.matrixWorldNeedsUpdate=t.matrixWorldNeedsUpdate,this.layers.mask=t.layers.mask,this.visible=t.visible,this.castShadow=t.castShadow,this.receiveShadow=t.receiveShadow,this.frustumCulled=t.frustumCulled,this.renderOrder=t.renderOrder,this.static=t.static,this.animations=t.animations.slice(),this.userData=JSON.parse(JSON.stringify(t.userData)),e===!0)for(let n=0;n<t.children.length;n++){const s=t.children[n];this.add(s.clone())}return this}dispose(){this.dispatchEvent({type:"dispose"})}}bn.DEFAULT_UP=new W(0,1,0);bn.DEFAULT_MATRIX_AUTO_UPDATE=!0;bn.DEFAULT_MATRIX_WORLD_AUTO_UPDATE=!0;class vr extends bn{constructor(){super(),this.isGroup=!0,this.type="Group"}}const cx={type:"move"};class Pl{constructor(){this._targetRay=null,this._grip=null,this._hand=null}getHandSpace(){return this._hand===null&&(this._hand=new vr,this._hand.matrixAutoUpdate=!1,this._hand.visible=!1,this._hand.joints={},this._hand.inputState={pinching:!1}),this._hand}getTargetRaySpace(){return this._targetRay===null&&(this._targetRay=new vr,this._targetRay.matrixAutoUpdate=!1,this._targetRay.visible=!1,this._targetRay.hasLinearVelocity=!1,this._targetRay.linearVelocity=new W,this._targetRay.hasAngularVelocity=!1,this._targetRay.angularVelocity=new W),this._targetRay}getGripSpace(){return this._grip===null&&(this._grip=new vr,this._grip.matrixAutoUpdate=!1,this._grip.visible=!1,this._grip.hasLinearVelocity=!1,this._grip.linearVelocity=new W,this._grip.hasAngularVelocity=!1,this._grip.angularVelocity=new W,this._grip.eventsEnabled=!1),this._grip}dispatchEvent(t){return this._targetRay!==null&&this._targetRay.dispatchEvent(t),this._grip!==null&&this._grip.dispatchEvent(t),this._hand!==null&&this._hand.dispatchEvent(t),this}connect(t){if(t&&t.hand){const e=this._hand;if(e)for(const n of t.hand.values())this._getHandJoint(e,n)}return this.dispatchEvent({type:"connected",data:t}),this}disconnect(t){return this.dispatchEvent({type:"disconnected",data:t}),this._targetRay!==null&&(this._targetRay.visible=!1),this._grip!==null&&(this._grip.visible=!1),this._hand!==null&&(this._hand.visible=!1),this}update(t,e,n){let s=null,r=null,a=null;const o=this._targetRay,l=this._grip,c=this._hand;if(t&&e.session.visibilityState!=="visible-blurred"){if(c&&t.hand){a=!0;for(const v of t.hand.values()){const m=e.getJointPose(v,n),p=this._getHandJoint(c,v);m!==null&&(p.matrix.fromArray(m.transform.matrix),p.matrix.decompose(p.position,p.quaternion,p.scale),p.matrixWorldNeedsUpdate=!0,p.jointRadius=m.radius),p.visible=m!==null}const h=c.joints["index-finger-tip"],u=c.joints["thumb-tip"],f=h.position.distanceTo(u.position),d=.02,x=.005;c.inputState.pinching&&f>d+x?(c.inputState.pinching=!1,this.dispatchEvent({type:"pinchend",handedness:t.handedness,target:this})):!c.inputState.pinching&&f<=d-x&&(c.inputState.pinching=!0,this.dispatchEvent({type:"pinchstart",handedness:t.handedness,target:this}))}else l!==null&&t.gripSpace&&(r=e.getPose(t.gripSpace,n),r!==null&&(l.matrix.fromArray(r.transform.matrix),l.matrix.decompose(l.position,l.quaternion,l.scale),l.matrixWorldNeedsUpdate=!0,r.linearVelocity?(l.hasLinearVelocity=!0,l.linearVelocity.copy(r.linearVelocity)):l.hasLinearVelocity=!1,r.angularVelocity?(l.hasAngularVelocity=!0,l.angularVelocity.copy(r.angularVelocity)):l.hasAngularVelocity=!1,l.eventsEnabled&&l.dispatchEvent({type:"gripUpdated",data:t,target:this})));o!==null&&(s=e.getPose(t.targetRaySpace,n),s===null&&r!==null&&(s=r),s!==null&&(o.matrix.fromArray(s.transform.matrix),o.matrix.decompose(o.position,o.quaternion,o.scale),o.matrixWorldNeedsUpdate=!0,s.linearVelocity?(o.hasLinearVelocity=!0,o.linearVelocity.copy(s.linearVelocity)):o.hasLinearVelocity=!1,s.angularVelocity?(o.hasAngularVelocity=!0,o.angularVelocity.copy(s.angularVelocity)):o.hasAngularVelocity=!1,this.dispatchEvent(cx)))}return o!==null&&(o.visible=s!==null),l!==null&&(l.visible=r!==null),c!==null&&(c.visible=a!==null),this}_getHandJoint(t,e){if(t.joints[e.jointName]===void 0){const n=new vr;n.matrixAutoUpdate=!1,n.visible=!1,t.joints[e.jointName]=n,t.add(n)}return t.joints[e.jointName]}}const Rp={aliceblue:15792383,antiquewhite:16444375,aqua:65535,aquamarine:8388564,azure:15794175,beige:16119260,bisque:16770244,black:0,blanchedalmond:16772045,blue:255,blueviolet:9055202,brown:10824234,burlywood:14596231,cadetblue:6266528,chartreuse:8388352,chocolate:13789470,coral:16744272,cornflowerblue:6591981,cornsilk:16775388,crimson:14423100,cyan:65535,darkblue:139,darkcyan:35723,darkgoldenrod:12092939,darkgray:11119017,darkgreen:25600,darkgrey:11119017,darkkhaki:12433259,darkmagenta:9109643,darkolivegreen:5597999,darkorange:16747520,darkorchid:10040012,darkred:9109504,darksalmon:15308410,darkseagreen:9419919,darkslateblue:4734347,darkslategray:3100495,darkslategrey:3100495,darkturquoise:52945,darkviolet:9699539,deeppink:16716947,deepskyblue:49151,dimgray:6908265,dimgrey:6908265,dodgerblue:2003199,firebrick:11674146,floralwhite:16775920,forestgreen:2263842,fuchsia:16711935,gainsboro:14474460,ghostwhite:16316671,gold:16766720,goldenrod:14329120,gray:8421504,green:32768,greenyellow:11403055,grey:8421504,honeydew:15794160,hotpink:16738740,indianred:13458524,indigo:4915330,ivory:16777200,khaki:15787660,lavender:15132410,lavenderblush:16773365,lawngreen:8190976,lemonchiffon:16775885,lightblue:11393254,lightcoral:15761536,lightcyan:14745599,lightgoldenrodyellow:16448210,lightgray:13882323,lightgreen:9498256,lightgrey:13882323,lightpink:16758465,lightsalmon:16752762,lightseagreen:2142890,lightskyblue:8900346,lightslategray:7833753,lightslategrey:7833753,lightsteelblue:11584734,lightyellow:16777184,lime:65280,limegreen:3329330,linen:16445670,magenta:16711935,maroon:8388608,mediumaquamarine:6737322,mediumblue:205,mediumorchid:12211667,mediumpurple:9662683,mediumseagreen:3978097,mediumslateblue:8087790,mediumspringgreen:64154,mediumturquoise:4772300,mediumvioletred:13047173,midnightblue:1644912,mintcream:16121850,mistyrose:16770273,moccasin:16770229,navajowhite:16768685,navy:128,oldlace:16643558,olive:8421376,olivedrab:7048739,orange:16753920,orangered:16729344,orchid:14315734,palegoldenrod:15657130,palegreen:10025880,paleturquoise:11529966,palevioletred:14381203,papayawhip:16773077,peachpuff:16767673,peru:13468991,pink:16761035,plum:14524637,powderblue:11591910,purple:8388736,rebeccapurple:6697881,red:16711680,rosybrown:12357519,royalblue:4286945,saddlebrown:9127187,salmon:16416882,sandybrown:16032864,seagreen:3050327,seashell:16774638,sienna:10506797,silver:12632256,skyblue:8900331,slateblue:6970061,slategray:7372944,slategrey:7372944,snow:16775930,springgreen:65407,steelblue:4620980,tan:13808780,teal:32896,thistle:14204888,tomato:16737095,turquoise:4251856,violet:15631086,wheat:16113331,white:16777215,whitesmoke:16119285,yellow:16776960,yellowgreen:10145074},ds={h:0,s:0,l:0},Va={h:0,s:0,l:0};function Ll(i,t,e){return e<0&&(e+=1),e>1&&(e-=1),e<1/6?i+(t-i)*6*e:e<1/2?t:e<2/3?i+(t-i)*6*(2/3-e):i}class se{constructor(t,e,n){return this.isColor=!0,this.r=1,this.g=1,this.b=1,this.set(t,e,n)}set(t,e,n){if(e===void 0&&n===void 0){const s=t;s&&s.isColor?this.copy(s):typeof s=="number"?this.setHex(s):typeof s=="string"&&this.setStyle(s)}else this.setRGB(t,e,n);return this}setScalar(t){return this.r=t,this.g=t,this.b=t,this}setHex(t,e=oi){return t=Math.floor(t),this.r=(t>>16&255)/255,this.g=(t>>8&255)/255,this.b=(t&255)/255,_e.colorSpaceToWorking(this,e),this}setRGB(t,e,n,s=_e.workingColorSpace){return this.r=t,this.g=e,this.b=n,_e.colorSpaceToWorking(this,s),this}setHSL(t,e,n,s=_e.workingColorSpace){if(t=$0(t,1),e=fe(e,0,1),n=fe(n,0,1),e===0)this.r=this.g=this.b=n;else{const r=n<=.5?n*(1+e):n+e-n*e,a=2*n-r;this.r=Ll(a,r,t+1/3),this.g=Ll(a,r,t),this.b=Ll(a,r,t-1/3)}return _e.colorSpaceToWorking(this,s),this}setStyle(t,e=oi){function n(r){r!==void 0&&parseFloat(r)<1&&Kt("Color: Alpha component of "+t+" will be ignored.")}let s;if(s=/^(\w+)\(([^\)]*)\)/.exec(t)){let r;const a=s[1],o=s[2];switch(a){case"rgb":case"rgba":if(r=/^\s*(\d+)\s*,\s*(\d+)\s*,\s*(\d+)\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(o))return n(r[4]),this.setRGB(Math.min(255,parseInt(r[1],10))/255,Math.min(255,parseInt(r[2],10))/255,Math.min(255,parseInt(r[3],10))/255,e);if(r=/^\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(o))return n(r[4]),this.setRGB(Math.min(100,parseFloat(r[1]))/100,Math.min(100,parseFloat(r[2]))/100,Math.min(100,parseFloat(r[3]))/100,e);break;case"hsl":case"hsla":if(r=/^\s*([+-]?(?:\d+(?:\.\d+)?|\.\d+))\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(o))return n(r[4]),this.setHSL(parseFloat(r[1])/360,parseFloat(r[2])/100,parseFloat(r[3])/100,e);break;default:Kt("Color: Unknown color model "+t)}}else if(s=/^\#([A-Fa-f\d]+)$/.exec(t)){const r=s[1],a=r.length;if(a===3)return this.setRGB(parseInt(r.charAt(0),16)/15,parseInt(r.charAt(1),16)/15,parseInt(r.charAt(2),16)/15,e);if(a===6)return this.setHex(parseInt(r,16),e);Kt("Color: Invalid hex color "+t)}else if(t&&t.length>0)return this.setColorName(t,e);return this}setColorName(t,e=oi){const n=Rp[t.toLowerCase()];return n!==void 0?this.setHex(n,e):Kt("Color: Unknown color "+t),this}clone(){return new this.constructor(this.r,this.g,this.b)}copy(t){return this.r=t.r,this.g=t.g,this.b=t.b,this}copySRGBToLinear(t){return this.r=is(t.r),this.g=is(t.g),this.b=is(t.b),this}copyLinearToSRGB(t){return this.r=br(t.r),this.g=br(t.g),this.b=br(t.b),this}convertSRGBToLinear(){return this.copySRGBToLinear(this),this}convertLinearToSRGB(){return this.copyLinearToSRGB(this),this}getHex(t=oi){return _e.workingToColorSpace(Ln.copy(this),t),Math.round(fe(Ln.r*255,0,255))*65536+Math.round(fe(Ln.g*255,0,255))*256+Math.round(fe(Ln.b*255,0,255))}getHexString(t=oi){return("000000"+this.getHex(t).toString(16)).slice(-6)}getHSL(t,e=_e.workingColorSpace){_e.workingToColorSpace(Ln.copy(this),e);const n=Ln.r,s=Ln.g,r=Ln.b,a=Math.max(n,s,r),o=Math.min(n,s,r);let l,c;const h=(o+a)/2;if(o===a)l=0,c=0;else{const u=a-o;switch(c=h<=.5?u/(a+o):u/(2-a-o),a){case n:l=(s-r)/u+(s<r?6:0);break;case s:l=(r-n)/u+2;break;case r:l=(n-s)/u+4;break}l/=6}return t.h=l,t.s=c,t.l=h,t}getRGB(t,e=_e.workingColorSpace){return _e.workingToColorSpace(Ln.copy(this),e),t.r=Ln.r,t.g=Ln.g,t.b=Ln.b,t}getStyle(t=oi){_e.workingToColorSpace(Ln.copy(this),t);const e=Ln.r,n=Ln.g,s=Ln.b;return t!==oi?`color(${t} ${e.toFixed(3)} ${n.toFixed(3)} ${s.toFixed(3)})`:`rgb(${Math.round(e*255)},${Math.round(n*255)},${Math.round(s*255)})`}offsetHSL(t,e,n){return this.getHSL(ds),this.setHSL(ds.h+t,ds.s+e,ds.l+n)}add(t){return this.r+=t.r,this.g+=t.g,this.b+=t.b,this}addColors(t,e){return this.r=t.r+e.r,this.g=t.g+e.g,this.b=t.b+e.b,this}addScalar(t){return this.r+=t,this.g+=t,this.b+=t,this}sub(t){return this.r=Math.max(0,this.r-t.r),this.g=Math.max(0,this.g-t.g),this.b=Math.max(0,this.b-t.b),this}multiply(t){return this.r*=t.r,this.g*=t.g,this.b*=t.b,this}multiplyScalar(t){return this.r*=t,this.g*=t,this.b*=t,this}lerp(t,e){return this.r+=(t.r-this.r)*e,this.g+=(t.g-this.g)*e,this.b+=(t.b-this.b)*e,this}lerpColors(t,e,n){return this.r=t.r+(e.r-t.r)*n,this.g=t.g+(e.g-t.g)*n,this.b=t.b+(e.b-t.b)*n,this}lerpHSL(t,e){this.getHSL(ds),t.getHSL(Va);const n=bl(ds.h,Va.h,e),s=bl(ds.s,Va.s,e),r=bl(ds.l,Va.l,e);return this.setHSL(n,s,r),this}setFromVector3(t){return this.r=t.x,this.g=t.y,this.b=t.z,this}applyMatrix3(t){const e=this.r,n=this.g,s=this.b,r=t.elements;return this.r=r[0]*e+r[3]*n+r[6]*s,this.g=r[1]*e+r[4]*n+r[7]*s,this.b=r[2]*e+r[5]*n+r[8]*s,this}equals(t){return t.r===this.r&&t.g===this.g&&t.b===this.b}fromArray(t,e=0){return this.r=t[e],this.g=t[e+1],this.b=t[e+2],this}toArray(t=[],e=0){return t[e]=this.r,t[e+1]=this.g,t[e+2]=this.b,t}fromBufferAttribute(t,e){return this.r=t.getX(e),this.g=t.getY(e),this.b=t.getZ(e),this}toJSON(){return this.getHex()}*[Symbol.iterator](){yield this.r,yield this.g,yield this.b}}const Ln=new se;se.NAMES=Rp;class hx extends bn{constructor(){super(),this.isScene=!0,this.type="Scene",this.background=null,this.environment=null,this.fog=null,this.backgroundBlurriness=0,this.backgroundIntensity=1,this.backgroundRotation=new ws,this.environmentIntensity=1,this.environmentRotation=new ws,this.overrideMaterial=null,typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}copy(t,e){return super.copy(t,e),this.background=t.background!==null?t.background.clone():null,this.environment=t.environment!==null?t.environment.clone():null,this.fog=t.fog!==null?t.fog.clone():null,this.backgroundBlurriness=t.backgroundBlurriness,this.backgroundIntensity=t.backgroundIntensity,this.backgroundRotation.copy(t.backgroundRotation),this.environmentIntensity=t.environmentIntensity,this.environmentRotation.copy(t.environmentRotation),this.overrideMaterial=t.overrideMaterial!==null?t.overrideMaterial.clone():null,this.matrixAutoUpdate=t.matrixAutoUpdate,this}toJSON(t){const e=super.toJSON(t);return this.fog!==null&&(e.object.fog=this.fog.toJSON()),e.object.backgroundBlurriness=this.backgroundBlurriness,e.object.backgroundIntensity=this.backgroundIntensity,e.object.backgroundRotation=this.backgroundRotation.toArray(),e.object.environmentIntensity=this.environmentIntensity,e.object.environmentRotation=this.environmentRotation.toArray(),e}}const di=new W,Xi=new W,Dl=new W,$i=new W,ar=new W,or=new W,vf=new W,Nl=new W,Il=new W,Ul=new W,Fl=new je,Ol=new je,kl=new je;class vi{constructor(t=new W,e=new W,n=new W){this.a=t,this.b=e,this.c=n}static getNormal(t,e,n,s){s.subVectors(n,e),di.subVectors(t,e),s.cross(di);const r=s.lengthSq();return r>0?s.multiplyScalar(1/Math.sqrt(r)):s.set(0,0,0)}static getBarycoord(t,e,n,s,r){di.subVectors(s,e),Xi.subVectors(n,e),Dl.subVectors(t,e);const a=di.dot(di),o=di.dot(Xi),l=di.dot(Dl),c=Xi.dot(Xi),h=Xi.dot(Dl),u=a*c-o*o;if(u===0)return r.set(0,0,0),null;const f=1/u,d=(c*l-o*h)*f,x=(a*h-o*l)*f;return r.set(1-d-x,x,d)}static containsPoint(t,e,n,s){return this.getBarycoord(t,e,n,s,$i)===null?!1:$i.x>=0&&$i.y>=0&&$i.x+$i.y<=1}static getInterpolation(t,e,n,s,r,a,o,l){return this.getBarycoord(t,e,n,s,$i)===null?(l.x=0,l.y=0,"z"in l&&(l.z=0),"w"in l&&(l.w=0),null):(l.setScalar(0),l.addScaledVector(r,$i.x),l.addScaledVector(a,$i.y),l.addScaledVector(o,$i.z),l)}static getInterpolatedAttribute(t,e,n,s,r,a){return Fl.setScalar(0),Ol.setScalar(0),kl.setScalar(0),Fl.fromBufferAttribute(t,e),Ol.fromBufferAttribute(t,n),kl.fromBufferAttribute(t,s),a.setScalar(0),a.addScaledVector(Fl,r.x),a.addScaledVector(Ol,r.y),a.addScaledVector(kl,r.z),a}static isFrontFacing(t,e,n,s){return di.subVectors(n,e),Xi.subVectors(t,e),di.cross(Xi).dot(s)<0}set(t,e,n){return this.a.copy(t),this.b.copy(e),this.c.copy(n),this}setFromPointsAndIndices(t,e,n,s){return this.a.copy(t[e]),this.b.copy(t[n]),this.c.copy(t[s]),this}setFromAttributeAndIndices(t,e,n,s){return this.a.fromBufferAttribute(t,e),this.b.fromBufferAttribute(t,n),this.c.fromBufferAttribute(t,s),this}clone(){return new this.constructor().copy(this)}copy(t){return this.a.copy(t.a),this.b.copy(t.b),this.c.copy(t.c),this}getArea(){return di.subVectors(this.c,this.b),Xi.subVectors(this.a,this.b),di.cross(Xi).length()*.5}getMidpoint(t){return t.addVectors(this.a,this.b).add(this.c).multiplyScalar(1/3)}getNormal(t){return vi.getNormal(this.a,this.b,this.c,t)}getPlane(t){return t.setFromCoplanarPoints(this.a,this.b,this.c)}getBarycoord(t,e){return vi.getBarycoord(t,this.a,this.b,this.c,e)}getInterpolation(t,e,n,s,r){return vi.getInterpolation(t,this.a,this.b,this.c,e,n,s,r)}containsPoint(t){return vi.containsPoint(t,this.a,this.b,this.c)}isFrontFacing(t){return vi.isFrontFacing(this.a,this.b,this.c,t)}intersectsBox(t){return t.intersectsTriangle(this)}closestPointToPoint(t,e){const n=this.a,s=this.b,r=this.c;let a,o;ar.subVectors(s,n),or.subVectors(r,n),Nl.subVectors(t,n);const l=ar.dot(Nl),c=or.dot(Nl);if(l<=0&&c<=0)return e.copy(n);Il.subVectors(t,s);const h=ar.dot(Il),u=or.dot(Il);if(h>=0&&u<=h)return e.copy(s);const f=l*u-h*c;if(f<=0&&l>=0&&h<=0&&l-h>0)return a=l/(l-h),e.copy(n).addScaledVector(ar,a);Ul.subVectors(t,r);const d=ar.dot(Ul),x=or.dot(Ul);if(x>=0&&d<=x)return e.copy(r);const v=d*c-l*x;if(v<=0&&c>=0&&x<=0)return o=c/(c-x),e.copy(n).addScaledVector(or,o);const m=h*x-d*u;if(m<=0&&u-h>=0&&d-x>=0)return vf.subVectors(r,s),o=(u-h)/(u-h+(d-x)),e.copy(s).addScaledVector(vf,o);const p=1/(m+v+f);return a=v*p,o=f*p,e.copy(n).addScaledVector(ar,a).addScaledVector(or,o)}equals(t){return t.a.equals(this.a)&&t.b.equals(this.b)&&t.c.equals(this.c)}}class Vs{constructor(t=new W(1/0,1/0,1/0),e=new W(-1/0,-1/0,-1/0)){this.isBox3=!0,this.min=t,this.max=e}set(t,e){return this.min.copy(t),this.max.copy(e),this}setFromArray(t){this.makeEmpty();for(let e=0,n=t.length;e<n;e+=3)this.expandByPoint(pi.fromArray(t,e));return this}setFromBufferAttribute(t){this.makeEmpty();for(let e=0,n=t.count;e<n;e++)this.expandByPoint(pi.fromBufferAttribute(t,e));return this}setFromPoints(t){this.makeEmpty();for(let e=0,n=t.length;e<n;e++)this.expandByPoint(t[e]);return this}setFromCenterAndSize(t,e){const n=pi.copy(e).multiplyScalar(.5);return this.min.copy(t).sub(n),this.max.copy(t).add(n),this}setFromObject(t,e=!1){return this.makeEmpty(),this.expandByObject(t,e)}clone(){return new this.constructor().copy(this)}copy(t){return this.min.copy(t.min),this.max.copy(t.max),this}makeEmpty(){return this.min.x=this.min.y=this.min.z=1/0,this.max.x=this.max.y=this.max.z=-1/0,this}isEmpty(){return this.max.x<this.min.x||this.max.y<this.min.y||this.max.z<this.min.z}getCenter(t){return this.isEmpty()?t.set(0,0,0):t.addVectors(this.min,this.max).multiplyScalar(.5)}getSize(t){return this.isEmpty()?t.set(0,0,0):t.subVectors(this.max,this.min)}expandByPoint(t){return this.min.min(t),this.max.max(t),this}expandByVector(t){return this.min.sub(t),this.max.add(t),this}expandByScalar(t){return this.min.addScalar(-t),this.max.addScalar(t),this}expandByObject(t,e=!1){t.updateWorldMatrix(!1,!1);const n=t.geometry;if(n!==void 0){const r=n.getAttribute("position");if(e===!0&&r!==void 0&&t.isInstancedMesh!==!0&&t.isBatchedMesh!==!0)for(let a=0,o=r.count;a<o;a++)t.isMesh===!0?t.getVertexPosition(a,pi):pi.fromBufferAttribute(r,a),pi.applyMatrix4(t.matrixWorld),this.expandByPoint(pi);else t.boundingBox!==void 0?(t.boundingBox===null&&t.computeBoundingBox(),Wa.copy(t.boundingBox)):(n.boundingBox===null&&n.computeBoundingBox(),Wa.copy(n.boundingBox)),Wa.applyMatrix4(t.matrixWorld),this.union(Wa)}const s=t.children;for(let r=0,a=s.length;r<a;r++)this.expandByObject(s[r],e);return this}containsPoint(t){return t.x>=this.min.x&&t.x<=this.max.x&&t.y>=this.min.y&&t.y<=this.max.y&&t.z>=this.min.z&&t.z<=this.max.z}containsBox(t){return this.min.x<=t.min.x&&t.max.x<=this.max.x&&this.min.y<=t.min.y&&t.max.y<=this.max.y&&this.min.z<=t.min.z&&t.max.z<=this.max.z}getParameter(t,e){return e.set((t.x-this.min.x)/(this.max.x-this.min.x),(t.y-this.min.y)/(this.max.y-this.min.y),(t.z-this.min.z)/(this.max.z-this.min.z))}intersectsBox(t){return t.max.x>=this.min.x&&t.min.x<=this.max.x&&t.max.y>=this.min.y&&t.min.y<=this.max.y&&t.max.z>=this.min.z&&t.min.z<=this.max.z}intersectsSphere(t){return this.clampPoint(t.center,pi),pi.distanceToSquared(t.center)<=t.radius*t.radius}intersectsPlane(t){let e,n;return t.normal.x>0?(e=t.normal.x*this.min.x,n=t.normal.x*this.max.x):(e=t.normal.x*this.max.x,n=t.normal.x*this.min.x),t.normal.y>0?(e+=t.normal.y*this.min.y,n+=t.normal.y*this.max.y):(e+=t.normal.y*this.max.y,n+=t.normal.y*this.min.y),t.normal.z>0?(e+=t.normal.z*this.min.z,n+=t.normal.z*this.max.z):(e+=t.normal.z*this.max.z,n+=t.normal.z*this.min.z),e<=-t.constant&&n>=-t.constant}intersectsTriangle(t){if(this.isEmpty())return!1;this.getCenter(ta),Xa.subVectors(this.max,ta),lr.subVectors(t.a,ta),cr.subVectors(t.b,ta),hr.subVectors(t.c,ta),ps.subVectors(cr,lr),ms.subVectors(hr,cr),Ps.subVectors(lr,hr);let e=[0,-ps.z,ps.y,0,-ms.z,ms.y,0,-Ps.z,Ps.y,ps.z,0,-ps.x,ms.z,0,-ms.x,Ps.z,0,-Ps.x,-ps.y,ps.x,0,-ms.y,ms.x,0,-Ps.y,Ps.x,0];return!Bl(e,lr,cr,hr,Xa)||(e=[1,0,0,0,1,0,0,0,1],!Bl(e,lr,cr,hr,Xa))?!1:($a.crossVectors(ps,ms),e=[$a.x,$a.y,$a.z],Bl(e,lr,cr,hr,Xa))}clampPoint(t,e){return e.copy(t).clamp(this.min,this.max)}distanceToPoint(t){return this.clampPoint(t,pi).distanceTo(t)}getBoundingSphere(t){return this.isEmpty()?t.makeEmpty():(this.getCenter(t.center),t.radius=this.getSize(pi).length()*.5),t}intersect(t){return this.min.max(t.min),this.max.min(t.max),this.isEmpty()&&this.makeEmpty(),this}union(t){return this.min.min(t.min),this.max.max(t.max),this}applyMatrix4(t){return this.isEmpty()?this:(Yi[0].set(this.min.x,this.min.y,this.min.z).applyMatrix4(t),Yi[1].set(this.min.x,this.min.y,this.max.z).applyMatrix4(t),Yi[2].set(this.min.x,this.max.y,this.min.z).applyMatrix4(t),Yi[3].set(this.min.x,this.max.y,this.max.z).applyMatrix4(t),Yi[4].set(this.max.x,this.min.y,this.min.z).applyMatrix4(t),Yi[5].set(this.max.x,this.min.y,this.max.z).applyMatrix4(t),Yi[6].set(this.max.x,this.max.y,this.min.z).applyMatrix4(t),Yi[7].set(this.max.x,this.max.y,this.max.z).applyMatrix4(t),this.setFromPoints(Yi),this)}translate(t){return this.min.add(t),this.max.add(t),this}equals(t){return t.min.equals(this.min)&&t.max.equals(this.max)}toJSON(){return{min:this.min.toArray(),max:this.max.toArray()}}fromJSON(t){return this.min.fromArray(t.min),this.max.fromArray(t.max),this}}const Yi=[new W,new W,new W,new W,new W,new W,new W,new W],pi=new W,Wa=new Vs,lr=new W,cr=new W,hr=new W,ps=new W,ms=new W,Ps=new W,ta=new W,Xa=new W,$a=new W,Ls=new W;function Bl(i,t,e,n,s){for(let r=0,a=i.length-3;r<=a;r+=3){Ls.fromArray(i,r);const o=s.x*Math.abs(Ls.x)+s.y*Math.abs(Ls.y)+s.z*Math.abs(Ls.z),l=t.dot(Ls),c=e.dot(Ls),h=n.dot(Ls);if(Math.max(-Math.max(l,c,h),Math.min(l,c,h))>o)return!1}return!0}const on=new W,Ya=new ee;let ux=0;class Ui extends Ts{constructor(t,e,n=!1){if(super(),Array.isArray(t))throw new TypeError("THREE.BufferAttribute: array should be a Typed Array.");this.isBufferAttribute=!0,Object.defineProperty(this,"id",{value:ux++}),this.name="",this.array=t,this.itemSize=e,this.count=t!==void 0?t.length/e:0,this.normalized=n,this.usage=H0,this.updateRanges=[],this.gpuType=Mi,this.version=0,this._normalizationScale=t!==void 0?Eh(t):void 0}onUploadCallback(){}set needsUpdate(t){t===!0&&this.version++}setUsage(t){return this.usage=t,this}addUpdateRange(t,e){this.updateRanges.push({start:t,count:e})}clearUpdateRanges(){this.updateRanges.length=0}copy(t){return this.name=t.name,this.array=new t.array.constructor(t.array),this.itemSize=t.itemSize,this.count=t.count,this.normalized=t.normalized,this.usage=t.usage,this.gpuType=t.gpuType,this._normalizationScale=t._normalizationScale,this}copyAt(t,e,n){t*=this.itemSize,n*=e.itemSize;for(let s=0,r=this.itemSize;s<r;s++)this.array[t+s]=e.array[n+s];return this}copyArray(t){return this.array.set(t),this}applyMatrix3(t){if(this.itemSize===2)for(let e=0,n=this.count;e<n;e++)Ya.fromBufferAttribute(this,e),Ya.applyMatrix3(t),this.setXY(e,Ya.x,Ya.y);else if(this.itemSize===3)for(let e=0,n=this.count;e<n;e++)on.fromBufferAttribute(this,e),on.applyMatrix3(t),this.setXYZ(e,on.x,on.y,on.z);return this}applyMatrix4(t){for(let e=0,n=this.count;e<n;e++)on.fromBufferAttribute(this,e),on.applyMatrix4(t),this.setXYZ(e,on.x,on.y,on.z);return this}applyNormalMatrix(t){for(let e=0,n=this.count;e<n;e++)on.fromBufferAttribute(this,e),on.applyNormalMatrix(t),this.setXYZ(e,on.x,on.y,on.z);return this}transformDirection(t){for(let e=0,n=this.count;e<n;e++)on.fromBufferAttribute(this,e),on.transformDirection(t),this.setXYZ(e,on.x,on.y,on.z);return this}set(t,e=0){return this.array.set(t,e),this}getComponent(t,e){let n=this.array[t*this.itemSize+e];return this.normalized&&(n=this._denormalize(n)),n}setComponent(t,e,n){return this.normalized&&(n=this._normalize(n)),this.array[t*this.itemSize+e]=n,this}getX(t){let e=this.array[t*this.itemSize];return this.normalized&&(e=this._denormalize(e)),e}setX(t,e){return this.normalized&&(e=this._normalize(e)),this.array[t*this.itemSize]=e,this}getY(t){let e=this.array[t*this.itemSize+1];return this.normalized&&(e=this._denormalize(e)),e}setY(t,e){return this.normalized&&(e=this._normalize(e)),this.array[t*this.itemSize+1]=e,this}getZ(t){let e=this.array[t*this.itemSize+2];return this.normalized&&(e=this._denormalize(e)),e}setZ(t,e){return this.normalized&&(e=this._normalize(e)),this.array[t*this.itemSize+2]=e,this}getW(t){let e=this.array[t*this.itemSize+3];return this.normalized&&(e=this._denormalize(e)),e}setW(t,e){return this.normalized&&(e=this._normalize(e)),this.array[t*this.itemSize+3]=e,this}setXY(t,e,n){return t*=this.itemSize,this.normalized&&(e=this._normalize(e),n=this._normalize(n)),this.array[t+0]=e,this.array[t+1]=n,this}setXYZ(t,e,n,s){return t*=this.itemSize,this.normalized&&(e=this._normalize(e),n=this._normalize(n),s=this._normalize(s)),this.array[t+0]=e,this.array[t+1]=n,this.array[t+2]=s,this}setXYZW(t,e,n,s,r){return t*=this.itemSize,this.normalized&&(e=this._normalize(e),n=this._normalize(n),s=this._normalize(s),r=this._normalize(r)),this.array[t+0]=e,this.array[t+1]=n,this.array[t+2]=s,this.array[t+3]=r,this}onUpload(t){return this.onUploadCallback=t,this}clone(){return new this.constructor(this.array,this.itemSize).copy(this)}toJSON(){const t={itemSize:this.itemSize,type:this.array.constructor.name,array:Array.from(this.array),normalized:this.normalized};return t.name=this.name,t.usage=this.usage,t.gpuType=this.gpuType,t}dispose(){this.dispatchEvent({type:"dispose"})}_denormalize(t){const e=this._normalizationScale;return e!==void 0?Math.max(t/e,-1):q0(t,this.array)}_normalize(t){const e=this._normalizationScale;return e!==void 0?Math.round(t*e):K0(t,this.array)}}class Cp extends Ui{constructor(t,e,n){super(new Uint16Array(t),e,n)}}class Pp extends Ui{constructor(t,e,n){super(new Uint32Array(t),e,n)}}class wn extends Ui{constructor(t,e,n){super(new Float32Array(t),e,n)}}const fx=new Vs,ea=new W,zl=new W;class Or{constructor(t=new W,e=-1){this.isSphere=!0,this.center=t,this.radius=e}set(t,e){return this.center.copy(t),this.radius=e,this}setFromPoints(t,e){const n=this.center;e!==void 0?n.copy(e):fx.setFromPoints(t).getCenter(n);let s=0;for(let r=0,a=t.length;r<a;r++)s=Math.max(s,n.distanceToSquared(t[r]));return this.radius=Math.sqrt(s),this}copy(t){return this.center.copy(t.center),this.radius=t.radius,this}isEmpty(){return this.radius<0}makeEmpty(){return this.center.set(0,0,0),this.radius=-1,this}containsPoint(t){return t.distanceToSquared(this.center)<=this.radius*this.radius}distanceToPoint(t){return t.distanceTo(this.center)-this.radius}intersectsSphere(t){const e=this.radius+t.radius;return t.center.distanceToSquared(this.center)<=e*e}intersectsBox(t){return t.intersectsSphere(this)}intersectsPlane(t){return Math.abs(t.distanceToPoint(this.center))<=this.radius}clampPoint(t,e){const n=this.center.distanceToSquared(t);return e.copy(t),n>this.radius*this.radius&&(e.sub(this.center).normalize(),e.multiplyScalar(this.radius).add(this.center)),e}getBoundingBox(t){return this.isEmpty()?(t.makeEmpty(),t):(t.set(this.center,this.center),t.expandByScalar(this.radius),t)}applyMatrix4(t){return this.center.applyMatrix4(t),this.radius=this.radius*t.getMaxScaleOnAxis(),this}translate(t){return this.center.add(t),this}expandByPoint(t){if(this.isEmpty())return this.center.copy(t),this.radius=0,this;ea.subVectors(t,this.center);const e=ea.lengthSq();if(e>this.radius*this.radius){const n=Math.sqrt(e),s=(n-this.radius)*.5;this.center.addScaledVector(ea,s/n),this.radius+=s}return this}union(t){return t.isEmpty()?this:this.isEmpty()?(this.copy(t),this):(this.center.equals(t.center)===!0?this.radius=Math.max(this.radius,t.radius):(zl.subVectors(t.center,this.center).setLength(t.radius),this.expandByPoint(ea.copy(t.center).add(zl)),this.expandByPoint(ea.copy(t.center).sub(zl))),this)}equals(t){return t.center.equals(this.center)&&t.radius===this.radius}clone(){return new this.constructor().copy(this)}toJSON(){return{radius:this.radius,center:this.center.toArray()}}fromJSON(t){return this.radius=t.radius,this.center.fromArray(t.center),this}}let dx=0;const si=new Pe,Hl=new bn,ur=new W,Jn=new Vs,na=new Vs,En=new W;class li extends Ts{constructor(){super(),this.isBufferGeometry=!0,Object.defineProperty(this,"id",{value:dx++}),this.uuid=Ta(),this.name="",this.type="BufferGeometry",this.index=null,this.indirect=null,this.indirectOffset=0,this.attributes={},this.morphAttributes={},this.morphTargetsRelative=!1,this.groups=[],this.boundingBox=null,this.boundingSphere=null,this.drawRange={start:0,count:1/0},this.userData={},this._transformed=!1}getIndex(){return this.index}setIndex(t){return Array.isArray(t)?this.index=new(G0(t)?Pp:Cp)(t,1):this.index=t,this}setIndirect(t,e=0){return this.indirect=t,this.indirectOffset=e,this}getIndirect(){return this.indirect}getAttribute(t){return this.attributes[t]}setAttribute(t,e){return this.attributes[t]=e,this}deleteAttribute(t){return delete this.attributes[t],this}hasAttribute(t){return this.attributes[t]!==void 0}addGroup(t,e,n=0){this.groups.push({start:t,count:e,materialIndex:n})}clearGroups(){this.groups=[]}setDrawRange(t,e){this.drawRange.start=t,this.drawRange.count=e}applyMatrix4(t){const e=this.attributes.position;e!==void 0&&(e.applyMatrix4(t),e.needsUpdate=!0);const n=this.attributes.normal;if(n!==void 0){const r=new ne().getNormalMatrix(t);n.applyNormalMatrix(r),n.needsUpdate=!0}const s=this.attributes.tangent;return s!==void 0&&(s.transformDirection(t),s.needsUpdate=!0),this.boundingBox!==null&&this.computeBoundingBox(),this.boundingSphere!==null&&this.computeBoundingSphere(),this._transformed=!0,this}applyQuaternion(t){return si.makeRotationFromQuaternion(t),this.applyMatrix4(si),this}rotateX(t){return si.makeRotationX(t),this.applyMatrix4(si),this}rotateY(t){return si.makeRotationY(t),this.applyMatrix4(si),this}rotateZ(t){return si.makeRotationZ(t),this.applyMatrix4(si),this}translate(t,e,n){return si.makeTranslation(t,e,n),this.applyMatrix4(si),this}scale(t,e,n){return si.makeScale(t,e,n),this.applyMatrix4(si),this}lookAt(t){return Hl.lookAt(t),Hl.updateMatrix(),this.applyMatrix4(Hl.matrix),this}center(){return this.computeBoundingBox(),this.boundingBox.getCenter(ur).negate(),this.translate(ur.x,ur.y,ur.z),this}setFromPoints(t){const e=this.getAttribute("position");if(e===void 0){const n=[];for(let s=0,r=t.length;s<r;s++){const a=t[s];n.push(a.x,a.y,a.z||0)}this.setAttribute("position",new wn(n,3))}else{const n=Math.min(t.length,e.count);for(let s=0;s<n;s++){const r=t[s];e.setXYZ(s,r.x,r.y,r.z||0)}t.length>e.count&&Kt("BufferGeometry: Buffer size too small for points data. Use .dispose() and create a new geometry."),e.needsUpdate=!0}return this}computeBoundingBox(){this.boundingBox===null&&(this.boundingBox=new Vs);const t=this.attributes.position,e=this.morphAttributes.position;if(t&&t.isGLBufferAttribute){Ee("BufferGeometry.computeBoundingBox(): GLBufferAttribute requires a manual bounding box.",this),this.boundingBox.set(new W(-1/0,-1/0,-1/0),new W(1/0,1/0,1/0));return}if(t!==void 0){if(this.boundingBox.setFromBufferAttribute(t),e)for(let n=0,s=e.length;n<s;n++){const r=e[n];Jn.setFromBufferAttribute(r),this.morphTargetsRelative?(En.addVectors(this.boundingBox.min,Jn.min),this.boundingBox.expandByPoint(En),En.addVectors(this.boundingBox.max,Jn.max),this.boundingBox.expandByPoint(En)):(this.boundingBox.expandByPoint(Jn.min),this.boundingBox.expandByPoint(Jn.max))}}else this.boundingBox.makeEmpty();(isNaN(this.boundingBox.min.x)||isNaN(this.boundingBox.min.y)||isNaN(this.boundingBox.min.z))&&Ee('BufferGeometry.computeBoundingBox(): Computed min/max have NaN values. The "position" attribute is likely to have NaN values.',this)}computeBoundingSphere(){this.boundingSphere===null&&(this.boundingSphere=new Or);const t=this.attributes.position,e=this.morphAttributes.position;if(t&&t.isGLBufferAttribute){Ee("BufferGeometry.computeBoundingSphere(): GLBufferAttribute requires a manual bounding sphere.",this),this.boundingSphere.set(new W,1/0);return}if(t){const n=this.boundingSphere.center;if(Jn.setFromBufferAttribute(t),e)for(let r=0,a=e.length;r<a;r++){const o=e[r];na.setFromBufferAttribute(o),this.morphTargetsRelative?(En.addVectors(Jn.min,na.min),Jn.expandByPoint(En),En.addVectors(Jn.max,na.max),Jn.expandByPoint(En)):(Jn.expandByPoint(na.min),Jn.expandByPoint(na.max))}Jn.getCenter(n);let s=0;for(let r=0,a=t.count;r<a;r++)En.fromBufferAttribute(t,r),s=Math.max(s,n.distanceToSquared(En));if(e)for(let r=0,a=e.length;r<a;r++){const o=e[r],l=this.morphTargetsRelative;for(let c=0,h=o.count;c<h;c++)En.fromBufferAttribute(o,c),l&&(ur.fromBufferAttribute(t,c),En.add(ur)),s=Math.max(s,n.distanceToSquared(En))}this.boundingSphere.radius=Math.sqrt(s),isNaN(this.boundingSphere.radius)&&Ee('BufferGeometry.computeBoundingSphere(): Computed radius is NaN. The "position" attribute is likely to have NaN values.',this)}}computeTangents(){const t=this.index,e=this.attributes;if(t===null||e.position===void 0||e.normal===void 0||e.uv===void 0){Ee("BufferGeometry: .computeTangents() failed. Missing required attributes (index, position, normal or uv)");return}const n=e.position,s=e.normal,r=e.uv;let a=this.getAttribute("tangent");(a===void 0||a.count!==n.count)&&(a=new Ui(new Float32Array(4*n.count),4),this.setAttribute("tangent",a));const o=[],l=[],c=new Uint8Array(n.count);for(let B=0;B<n.count;B++)o[B]=new W,l[B]=new W;const h=new W,u=new W,f=new W,d=new ee,x=new ee,v=new ee,m=new W,p=new W;function S(B,I,D){c[B]=c[I]=c[D]=1,h.fromBufferAttribute(n,B),u.fromBufferAttribute(n,I),f.fromBufferAttribute(n,D),d.fromBufferAttribute(r,B),x.fromBufferAttribute(r,I),v.fromBufferAttribute(r,D),u.sub(h),f.sub(h),x.sub(d),v.sub(d);const z=1/(x.x*v.y-v.x*x.y);isFinite(z)&&(m.copy(u).multiplyScalar(v.y).addScaledVector(f,-x.y).multiplyScalar(z),p.copy(f).multiplyScalar(x.x).addScaledVector(u,-v.x).multiplyScalar(z),o[B].add(m),o[I].add(m),o[D].add(m),l[B].add(p),l[I].add(p),l[D].add(p))}let C=this.groups;C.length===0&&(C=[{start:0,count:t.count}]);for(let B=0,I=C.length;B<I;++B){const D=C[B],z=D.start,V=D.count;for(let N=z,H=z+V;N<H;N+=3)S(t.getX(N+0),t.getX(N+1),t.getX(N+2))}const b=new W,P=new W,T=new W,_=new W;function w(B){T.fromBufferAttribute(s,B),_.copy(T);const I=o[B];b.copy(I),b.sub(T.multiplyScalar(T.dot(I))).normalize(),P.crossVectors(_,I);const z=P.dot(l[B])<0?-1:1;a.setXYZW(B,b.x,b.y,b.z,z)}for(let B=0,I=n.count;B<I;++B)c[B]&&w(B);this._transformed=!0}computeVertexNormals(){const t=this.index,e=this.getAttribute("position");if(e!==void 0){let n=this.getAttribute("normal");if(n===void 0||n.count!==e.count)n=new Ui(new Float32Array(e.count*3),3),this.setAttribute("normal",n);else for(let f=0,d=n.count;f<d;f++)n.setXYZ(f,0,0,0);const s=new W,r=new W,a=new W,o=new W,l=new W,c=new W,h=new W,u=new W;if(t)for(let f=0,d=t.count;f<d;f+=3){const x=t.getX(f+0),v=t.getX(f+1),m=t.getX(f+2);s.fromBufferAttribute(e,x),r.fromBufferAttribute(e,v),a.fromBufferAttribute(e,m),h.subVectors(a,r),u.subVectors(s,r),h.cross(u),o.fromBufferAttribute(n,x),l.fromBufferAttribute(n,v),c.fromBufferAttribute(n,m),o.add(h),l.add(h),c.add(h),n.setXYZ(x,o.x,o.y,o.z),n.setXYZ(v,l.x,l.y,l.z),n.setXYZ(m,c.x,c.y,c.z)}else for(let f=0,d=e.count;f<d;f+=3)s.fromBufferAttribute(e,f+0),r.fromBufferAttribute(e,f+1),a.fromBufferAttribute(e,f+2),h.subVectors(a,r),u.subVectors(s,r),h.cross(u),n.setXYZ(f+0,h.x,h.y,h.z),n.setXYZ(f+1,h.x,h.y,h.z),n.setXYZ(f+2,h.x,h.y,h.z);this.normalizeNormals(),n.needsUpdate=!0}}normalizeNormals(){const t=this.attributes.normal;for(let e=0,n=t.count;e<n;e++)En.fromBufferAttribute(t,e),En.normalize(),t.setXYZ(e,En.x,En.y,En.z)}toNonIndexed(){function t(o,l){const c=o.array,h=o.itemSize,u=o.normalized,f=new c.constructor(l.length*h);let d=0,x=0;for(let v=0,m=l.length;v<m;v++){o.isInterleavedBufferAttribute?d=l[v]*o.data.stride+o.offset:d=l[v]*h;for(let p=0;p<h;p++)f[x++]=c[d++]}return new Ui(f,h,u)}if(this.index===null)return Kt("BufferGeometry.toNonIndexed(): BufferGeometry is already non-indexed."),this;const e=new li,n=this.index.array,s=this.attributes;for(const o in s){const l=s[o],c=t(l,n);e.setAttribute(o,c)}const r=this.morphAttributes;for(const o in r){const l=[],c=r[o];for(let h=0,u=c.length;h<u;h++){const f=c[h],d=t(f,n);l.push(d)}e.morphAttributes[o]=l}e.morphTargetsRelative=this.morphTargetsRelative;const a=this.groups;for(let o=0,l=a.length;o<l;o++){const c=a[o];e.addGroup(c.start,c.count,c.materialIndex)}return e}toJSON(){const t={metadata:{version:4.7,type:"BufferGeometry",generator:"BufferGeometry.toJSON"}};if(t.uuid=this.uuid,t.type=this.parameters!==void 0&&this._transformed===!0?"BufferGeometry":this.type,t.name=this.name,Object.keys(this.userData).length>0&&(t.userData=this.userData),this.parameters!==void 0&&this._transformed!==!0){const l=this.parameters;for(const c in l)l[c]!==void 0&&(t[c]=l[c]);return t}t.data={attributes:{}};const e=this.index;e!==null&&(t.data.index={type:e.array.constructor.name,array:Array.prototype.slice.call(e.array)});const n=this.attributes;for(const l in n){const c=n[l];t.data.attributes[l]=c.toJSON(t.data)}const s={};let r=!1;for(const l in this.morphAttributes){const c=this.morphAttributes[l],h=[];for(let u=0,f=c.length;u<f;u++){const d=c[u];h.push(d.toJSON(t.data))}h.length>0&&(s[l]=h,r=!0)}r&&(t.data.morphAttributes=s,t.data.morphTargetsRelative=this.morphTargetsRelative);const a=this.groups;a.length>0&&(t.data.groups=JSON.parse(JSON.stringify(a)));const o=this.boundingSphere;return o!==null&&(t.data.boundingSphere=o.toJSON()),t}clone(){return new this.constructor().copy(this)}copy(t){this.index=null,this.attributes={},this.morphAttributes={},this.groups=[],this.boundingBox=null,this.boundingSphere=null;const e={};this.name=t.name;const n=t.index;n!==null&&this.setIndex(n.clone());const s=t.attributes;for(const c in s){const h=s[c];this.setAttribute(c,h.clone(e))}const r=t.morphAttributes;for(const c in r){const h=[],u=r[c];for(let f=0,d=u.length;f<d;f++)h.push(u[f].clone(e));this.morphAttributes[c]=h}this.morphTargetsRelative=t.morphTargetsRelative;const a=t.groups;for(let c=0,h=a.length;c<h;c++){const u=a[c];this.addGroup(u.start,u.count,u.materialIndex)}const o=t.boundingBox;o!==null&&(this.boundingBox=o.clone());const l=t.boundingSphere;return l!==null&&(this.boundingSphere=l.clone()),this.drawRange.start=t.drawRange.start,this.drawRange.count=t.drawRange.count,this.userData=t.userData,this._transformed=t._transformed,this}dispose(){this.dispatchEvent({type:"dispose"})}}const Gl=new W,px=new W,mx=new ne;class Zi{constructor(t=new W(1,0,0),e=0){this.isPlane=!0,this.normal=t,this.constant=e}set(t,e){return this.normal.copy(t),this.constant=e,this}setComponents(t,e,n,s){return this.normal.set(t,e,n),this.constant=s,this}setFromNormalAndCoplanarPoint(t,e){return this.normal.copy(t),this.constant=-e.dot(this.normal),this}setFromCoplanarPoints(t,e,n){const s=Gl.subVectors(n,e).cross(px.subVectors(t,e)).normalize();return this.setFromNormalAndCoplanarPoint(s,t),this}copy(t){return this.normal.copy(t.normal),this.constant=t.constant,this}normalize(){const t=1/this.normal.length();return this.normal.multiplyScalar(t),this.constant*=t,this}negate(){return this.constant*=-1,this.normal.negate(),this}distanceToPoint(t){return this.normal.dot(t)+this.constant}distanceToSphere(t){return this.distanceToPoint(t.center)-t.radius}projectPoint(t,e){return e.copy(t).addScaledVector(this.normal,-this.distanceToPoint(t))}intersectLine(t,e,n=!0){const s=t.delta(Gl),r=this.normal.dot(s);if(r===0)return this.distanceToPoint(t.start)===0?e.copy(t.start):null;const a=-(t.start.dot(this.normal)+this.constant)/r;return n===!0&&(a<0||a>1)?null:e.copy(t.start).addScaledVector(s,a)}intersectsLine(t){const e=this.distanceToPoint(t.start),n=this.distanceToPoint(t.end);return e<0&&n>0||n<0&&e>0}intersectsBox(t){return t.intersectsPlane(this)}intersectsSphere(t){return t.intersectsPlane(this)}coplanarPoint(t){return t.copy(this.normal).multiplyScalar(-this.constant)}applyMatrix4(t,e){const n=e||mx.getNormalMatrix(t),s=this.coplanarPoint(Gl).applyMatrix4(t),r=this.normal.applyMatrix3(n).normalize();return this.constant=-s.dot(r),this}translate(t){return this.constant-=t.dot(this.normal),this}equals(t){return t.normal.equals(this.normal)&&t.constant===this.constant}clone(){return new this.constructor().copy(this)}toJSON(){return{normal:this.normal.toArray(),constant:this.constant}}fromJSON(t){return this.normal.fromArray(t.normal),this.constant=t.constant,this}}let gx=0;class kr extends Ts{constructor(){super(),this.isMaterial=!0,Object.defineProperty(this,"id",{value:gx++}),this.uuid=Ta(),this.name="",this.type="Material",this.blending=xa,this.side=Bs,this.vertexColors=!1,this.opacity=1,this.transparent=!1,this.alphaHash=!1,this.blendSrc=ap,this.blendDst=op,this.blendEquation=gr,this.blendSrcAlpha=null,this.blendDstAlpha=null,this.blendEquationAlpha=null,this.blendColor=new se(0,0,0),this.blendAlpha=0,this.depthFunc=Sa,this.depthTest=!0,this.depthWrite=!0,this.stencilWriteMask=255,this.stencilFunc=U0,this.stencilRef=0,this.stencilFuncMask=255,this.stencilFail=El,this.stencilZFail=El,this.stencilZPass=El,this.stencilWrite=!1,this.clippingPlanes=null,this.clipIntersection=!1,this.clipShadows=!1,this.shadowSide=null,this.colorWrite=!0,this.precision=null,this.polygonOffset=!1,this.polygonOffsetFactor=0,this.polygonOffsetUnits=0,this.dithering=!1,this.alphaToCoverage=!1,this.premultipliedAlpha=!1,this.forceSinglePass=!1,this.allowOverride=!0,this.visible=!0,this.toneMapped=!0,this.userData={},this.version=0,this._alphaTest=0}get alphaTest(){return this._alphaTest}set alphaTest(t){this._alphaTest>0!=t>0&&this.version++,this._alphaTest=t}onBeforeRender(){}onBeforeCompile(){}customProgramCacheKey(){return this.onBeforeCompile.toString()}setValues(t){if(t!==void 0)for(const e in t){const n=t[e];if(n===void 0){Kt(`Material: parameter '${e}' has value of undefined.`);continue}const s=this[e];if(s===void 0){Kt(`Material: '${e}' is not a property of THREE.${this.type}.`);continue}s&&s.isColor?s.set(n):s&&s.isVector2&&n&&n.isVector2||s&&s.isEuler&&n&&n.isEuler||s&&s.isVector3&&n&&n.isVector3?s.copy(n):this[e]=n}}toJSON(t){const e=t===void 0||typeof t=="string";e&&(t={textures:{},images:{}});const n={metadata:{version:4.7,type:"Material",generator:"Material.toJSON"}};n.uuid=this.uuid,n.type=this.type,n.blending=this.blending,n.side=this.side,n.shadowSide=this.shadowSide,n.vertexColors=this.vertexColors,n.opacity=this.opacity,n.transparent=this.transparent,n.blendSrc=this.blendSrc,n.blendDst=this.blendDst,n.blendEquation=this.blendEquation,n.blendSrcAlpha=this.blendSrcAlpha,n.blendDstAlpha=this.blendDstAlpha,n.blendEquationAlpha=this.blendEquationAlpha,n.blendColor=this.blendColor.getHex(),n.blendAlpha=this.blendAlpha,n.depthFunc=this.depthFunc,n.depthTest=this.depthTest,n.depthWrite=this.depthWrite,n.colorWrite=this.colorWrite,n.clipIntersection=this.clipIntersection,n.clipShadows=this.clipShadows,n.stencilWriteMask=this.stencilWriteMask,n.stencilFunc=this.stencilFunc,n.stencilRef=this.stencilRef,n.stencilFuncMask=this.stencilFuncMask,n.stencilFail=this.stencilFail,n.stencilZFail=this.stencilZFail,n.stencilZPass=this.stencilZPass,n.stencilWrite=this.stencilWrite,n.polygonOffset=this.polygonOffset,n.polygonOffsetFactor=this.polygonOffsetFactor,n.polygonOffsetUnits=this.polygonOffsetUnits,n.dithering=this.dithering,n.alphaTest=this.alphaTest,n.alphaHash=this.alphaHash,n.alphaToCoverage=this.alphaToCoverage,n.premultipliedAlpha=this.premultipliedAlpha,n.forceSinglePass=this.forceSinglePass,n.allowOverride=this.allowOverride,n.visible=this.visible,n.toneMapped=this.toneMapped,n.name=this.name,this.color&&this.color.isColor&&(n.color=this.color.getHex()),this.roughness!==void 0&&(n.roughness=this.roughness),this.metalness!==void 0&&(n.metalness=this.metalness),this.sheen!==void 0&&(n.sheen=this.sheen),this.sheenColor&&this.sheenColor.isColor&&(n.sheenColor=this.sheenColor.getHex()),this.sheenRoughness!==void 0&&(n.sheenRoughness=this.sheenRoughness),this.emissive&&this.emissive.isColor&&(n.emissive=this.emissive.getHex()),this.emissiveIntensity!==void 0&&(n.emissiveIntensity=this.emissiveIntensity),this.specular&&this.specular.isColor&&(n.specular=this.specular.getHex()),this.specularIntensity!==void 0&&(n.specularIntensity=this.specularIntensity),this.specularColor&&this.specularColor.isColor&&(n.specularColor=this.specularColor.getHex()),this.shininess!==void 0&&(n.shininess=this.shininess),this.clearcoat!==void 0&&(n.clearcoat=this.clearcoat),this.clearcoatRoughness!==void 0&&(n.clearcoatRoughness=this.clearcoatRoughness),this.diffuseRoughness!==void 0&&(n.diffuseRoughness=this.diffuseRoughness),this.diffuseRoughnessMap&&this.diffuseRoughnessMap.isTexture&&(n.diffuseRoughnessMap=this.diffuseRoughnessMap.toJSON(t).uuid),this.clearcoatMap&&this.clearcoatMap.isTexture&&(n.clearcoatMap=this.clearcoatMap.toJSON(t).uuid),this.clearcoatRoughnessMap&&this.clearcoatRoughnessMap.isTexture&&(n.clearcoatRoughnessMap=this.clearcoatRoughnessMap.toJSON(t).uuid),this.clearcoatNormalMap&&this.clearcoatNormalMap.isTexture&&(n.clearcoatNormalMap=this.clearcoatNormalMap.toJSON(t).uuid,n.clearcoatNormalScale=this.clearcoatNormalScale.toArray()),this.sheenColorMap&&this.sheenColorMap.isTexture&&(n.sheenColorMap=this.sheenColorMap.toJSON(t).uuid),this.sheenRoughnessMap&&this.sheenRoughnessMap.isTexture&&(n.sheenRoughnessMap=this.sheenRoughnessMap.toJSON(t).uuid),this.dispersion!==void 0&&(n.dispersion=this.dispersion),this.retroreflectivity!==void 0&&(n.retroreflectivity=this.retroreflectivity),this.iridescence!==void 0&&(n.iridescence=this.iridescence),this.iridescenceIOR!==void 0&&(n.iridescenceIOR=this.iridescenceIOR),this.iridescenceThicknessMinimum!==void 0&&(n.iridescenceThicknessMinimum=this.iridescenceThicknessMinimum),this.iridescenceThicknessMaximum!==void 0&&(n.iridescenceThicknessMaximum=this.iridescenceThicknessMaximum),this.iridescenceMap&&this.iridescenceMap.isTexture&&(n.iridescenceMap=this.iridescenceMap.toJSON(t).uuid),this.iridescenceThicknessMap&&this.iridescenceThicknessMap.isTexture&&(n.iridescenceThicknessMap=this.iridescenceThicknessMap.toJSON(t).uuid),this.anisotropy!==void 0&&(n.anisotropy=this.anisotropy),this.anisotropyRotation!==void 0&&(n.anisotropyRotation=this.anisotropyRotation),this.anisotropyMap&&this.anisotropyMap.isTexture&&(n.anisotropyMap=this.anisotropyMap.toJSON(t).uuid),this.map&&this.map.isTexture&&(n.map=this.map.toJSON(t).uuid),this.matcap&&this.matcap.isTexture&&(n.matcap=this.matcap.toJSON(t).uuid),this.alphaMap&&this.alphaMap.isTexture&&(n.alphaMap=this.alphaMap.toJSON(t).uuid),this.lightMap&&this.lightMap.isTexture&&(n.lightMap=this.lightMap.toJSON(t).uuid,n.lightMapIntensity=this.lightMapIntensity),this.aoMap&&this.aoMap.isTexture&&(n.aoMap=this.aoMap.toJSON(t).uuid,n.aoMapIntensity=this.aoMapIntensity),this.bumpMap&&this.bumpMap.isTexture&&(n.bumpMap=this.bumpMap.toJSON(t).uuid,n.bumpScale=this.bumpScale),this.normalMap&&this.normalMap.isTexture&&(n.normalMap=this.normalMap.toJSON(t).uuid,n.normalMapType=this.normalMapType,n.normalScale=this.normalScale.toArray()),this.displacementMap&&this.displacementMap.isTexture&&(n.displacementMap=this.displacementMap.toJSON(t).uuid,n.displacementScale=this.displacementScale,n.displacementBias=this.displacementBias),this.roughnessMap&&this.roughnessMap.isTexture&&(n.roughnessMap=this.roughnessMap.toJSON(t).uuid),this.metalnessMap&&this.metalnessMap.isTexture&&(n.metalnessMap=this.metalnessMap.toJSON(t).uuid),this.emissiveMap&&this.emissiveMap.isTexture&&(n.emissiveMap=this.emissiveMap.toJSON(t).uuid),this.specularMap&&this.specularMap.isTexture&&(n.specularMap=this.specularMap.toJSON(t).uuid),this.specularIntensityMap&&this.specularIntensityMap.isTexture&&(n.specularIntensityMap=this.specularIntensityMap.toJSON(t).uuid),this.specularColorMap&&this.specularColorMap.isTexture&&(n.specularColorMap=this.specularColorMap.toJSON(t).uuid),this.envMap&&this.envMap.isTexture&&(n.envMap=this.envMap.toJSON(t).uuid,this.combine!==void 0&&(n.combine=this.combine)),this.envMapRotation!==void 0&&(n.envMapRotation=this.envMapRotation.toArray()),this.envMapIntensity!==void 0&&(n.envMapIntensity=this.envMapIntensity),this.reflectivity!==void 0&&(n.reflectivity=this.reflectivity),this.refractionRatio!==void 0&&(n.refractionRatio=this.refractionRatio),this.gradientMap&&this.gradientMap.isTexture&&(n.gradientMap=this.gradientMap.toJSON(t).uuid),this.transmission!==void 0&&(n.transmission=this.transmission),this.transmissionMap&&this.transmissionMap.isTexture&&(n.transmissionMap=this.transmissionMap.toJSON(t).uuid),this.thickness!==void 0&&(n.thickness=this.thickness),this.thicknessMap&&this.thicknessMap.isTexture&&(n.thicknessMap=this.thicknessMap.toJSON(t).uuid),this.attenuationDistance!==void 0&&(n.attenuationDistance=this.attenuationDistance),this.attenuationColor!==void 0&&(n.attenuationColor=this.attenuationColor.getHex()),this.size!==void 0&&(n.size=this.size),this.sizeAttenuation!==void 0&&(n.sizeAttenuation=this.sizeAttenuation),Array.isArray(this.clippingPlanes)&&this.clippingPlanes.length>0&&(n.clippingPlanes=this.clippingPlanes.map(r=>r.toJSON())),this.rotation!==void 0&&(n.rotation=this.rotation),this.depthPacking!==void 0&&(n.depthPacking=this.depthPacking),this.linewidth!==void 0&&(n.linewidth=this.linewidth),this.linecap!==void 0&&(n.linecap=this.linecap),this.linejoin!==void 0&&(n.linejoin=this.linejoin),this.dashSize!==void 0&&(n.dashSize=this.dashSize),this.gapSize!==void 0&&(n.gapSize=this.gapSize),this.scale!==void 0&&(n.scale=this.scale),this.wireframe!==void 0&&(n.wireframe=this.wireframe),this.wireframeLinewidth!==void 0&&(n.wireframeLinewidth=this.wireframeLinewidth),this.wireframeLinecap!==void 0&&(n.wireframeLinecap=this.wireframeLinecap),this.wireframeLinejoin!==void 0&&(n.wireframeLinejoin=this.wireframeLinejoin),this.flatShading!==void 0&&(n.flatShading=this.flatShading),this.fog!==void 0&&(n.fog=this.fog),Object.keys(this.userData).length>0&&(n.userData=this.userData);function s(r){const a=[];for(const o in r){const l=r[o];delete l.metadata,a.push(l)}return a}if(e){const r=s(t.textures),a=s(t.images);r.length>0&&(n.textures=r),a.length>0&&(n.images=a)}return n}fromJSON(t,e){if(t.uuid!==void 0&&(this.uuid=t.uuid),t.name!==void 0&&(this.name=t.name),t.color!==void 0&&this.color!==void 0&&this.color.setHex(t.color),t.roughness!==void 0&&(this.roughness=t.roughness),t.metalness!==void 0&&(this.metalness=t.metalness),t.sheen!==void 0&&(this.sheen=t.sheen),t.sheenColor!==void 0&&(this.sheenColor=new se().setHex(t.sheenColor)),t.sheenRoughness!==void 0&&(this.sheenRoughness=t.sheenRoughness),t.emissive!==void 0&&this.emissive!==void 0&&this.emissive.setHex(t.emissive),t.specular!==void 0&&this.specular!==void 0&&this.specular.setHex(t.specular),t.specularIntensity!==void 0&&(this.specularIntensity=t.specularIntensity),t.specularColor!==void 0&&this.specularColor!==void 0&&this.specularColor.setHex(t.specularColor),t.shininess!==void 0&&(this.shininess=t.shininess),t.clearcoat!==void 0&&(this.clearcoat=t.clearcoat),t.clearcoatRoughness!==void 0&&(this.clearcoatRoughness=t.clearcoatRoughness),t.diffuseRoughness!==void 0&&(this.diffuseRoughness=t.diffuseRoughness),t.dispersion!==void 0&&(this.dispersion=t.dispersion),t.retroreflectivity!==void 0&&(this.retroreflectivity=t.retroreflectivity),t.iridescence!==void 0&&(this.iridescence=t.iridescence),t.iridescenceIOR!==void 0&&(this.iridescenceIOR=t.iridescenceIOR),t.iridescenceThicknessMinimum!==void 0&&(this.iridescenceThicknessMinimum=t.iridescenceThicknessMinimum),t.iridescenceThicknessMaximum!==void 0&&(this.iridescenceThicknessMaximum=t.iridescenceThicknessMaximum),t.iridescenceThicknessRange!==void 0&&(this.iridescenceThicknessMinimum=t.iridescenceThicknessRange[0],this.iridescenceThicknessMaximum=t.iridescenceThicknessRange[1]),t.transmission!==void 0&&(this.transmission=t.transmission),t.thickness!==void 0&&(this.thickness=t.thickness),t.attenuationDistance!==void 0&&(this.attenuationDistance=t.attenuationDistance),t.attenuationColor!==void 0&&this.attenuationColor!==void 0&&this.attenuationColor.setHex(t.attenuationColor),t.anisotropy!==void 0&&(this.anisotropy=t.anisotropy),t.anisotropyRotation!==void 0&&(this.anisotropyRotation=t.anisotropyRotation),t.fog!==void 0&&(this.fog=t.fog),t.flatShading!==void 0&&(this.flatShading=t.flatShading),t.blending!==void 0&&(this.blending=t.blending),t.combine!==void 0&&(this.combine=t.combine),t.side!==void 0&&(this.side=t.side),t.shadowSide!==void 0&&(this.shadowSide=t.shadowSide),t.opacity!==void 0&&(this.opacity=t.opacity),t.transparent!==void 0&&(this.transparent=t.transparent),t.alphaTest!==void 0&&(this.alphaTest=t.alphaTest),t.alphaHash!==void 0&&(this.alphaHash=t.alphaHash),t.depthFunc!==void 0&&(this.depthFunc=t.depthFunc),t.depthTest!==void 0&&(this.depthTest=t.depthTest),t.depthWrite!==void 0&&(this.depthWrite=t.depthWrite),t.colorWrite!==void 0&&(this.colorWrite=t.colorWrite),t.clippingPlanes!==void 0&&(this.clippingPlanes=t.clippingPlanes.map(n=>new Zi().fromJSON(n))),t.clipIntersection!==void 0&&(this.clipIntersection=t.clipIntersection),t.clipShadows!==void 0&&(this.clipShadows=t.clipShadows),t.depthPacking!==void 0&&(this.depthPacking=t.depthPacking),t.blendSrc!==void 0&&(this.blendSrc=t.blendSrc),t.blendDst!==void 0&&(this.blendDst=t.blendDst),t.blendEquation!==void 0&&(this.blendEquation=t.blendEquation),t.blendSrcAlpha!==void 0&&(this.blendSrcAlpha=t.blendSrcAlpha),t.blendDstAlpha!==void 0&&(this.blendDstAlpha=t.blendDstAlpha),t.blendEquationAlpha!==void 0&&(this.blendEquationAlpha=t.blendEquationAlpha),t.blendColor!==void 0&&this.blendColor!==void 0&&this.blendColor.setHex(t.blendColor),t.blendAlpha!==void 0&&(this.blendAlpha=t.blendAlpha),t.stencilWriteMask!==void 0&&(this.stencilWriteMask=t.stencilWriteMask),t.stencilFunc!==void 0&&(this.stencilFunc=t.stencilFunc),t.stencilRef!==void 0&&(this.stencilRef=t.stencilRef),t.stencilFuncMask!==void 0&&(this.stencilFuncMask=t.stencilFuncMask),t.stencilFail!==void 0&&(this.stencilFail=t.stencilFail),t.stencilZFail!==void 0&&(this.stencilZFail=t.stencilZFail),t.stencilZPass!==void 0&&(this.stencilZPass=t.stencilZPass),t.stencilWrite!==void 0&&(this.stencilWrite=t.stencilWrite),t.wireframe!==void 0&&(this.wireframe=t.wireframe),t.wireframeLinewidth!==void 0&&(this.wireframeLinewidth=t.wireframeLinewidth),t.wireframeLinecap!==void 0&&(this.wireframeLinecap=t.wireframeLinecap),t.wireframeLinejoin!==void 0&&(this.wireframeLinejoin=t.wireframeLinejoin),t.rotation!==void 0&&(this.rotation=t.rotation),t.linewidth!==void 0&&(this.linewidth=t.linewidth),t.linecap!==void 0&&(this.linecap=t.linecap),t.linejoin!==void 0&&(this.linejoin=t.linejoin),t.dashSize!==void 0&&(this.dashSize=t.dashSize),t.gapSize!==void 0&&(this.gapSize=t.gapSize),t.scale!==void 0&&(this.scale=t.scale),t.polygonOffset!==void 0&&(this.polygonOffset=t.polygonOffset),t.polygonOffsetFactor!==void 0&&(this.polygonOffsetFactor=t.polygonOffsetFactor),t.polygonOffsetUnits!==void 0&&(this.polygonOffsetUnits=t.polygonOffsetUnits),t.dithering!==void 0&&(this.dithering=t.dithering),t.alphaToCoverage!==void 0&&(this.alphaToCoverage=t.alphaToCoverage),t.premultipliedAlpha!==void 0&&(this.premultipliedAlpha=t.premultipliedAlpha),t.forceSinglePass!==void 0&&(this.forceSinglePass=t.forceSinglePass),t.allowOverride!==void 0&&(this.allowOverride=t.allowOverride),t.visible!==void 0&&(this.visible=t.visible),t.toneMapped!==void 0&&(this.toneMapped=t.toneMapped),t.userData!==void 0&&(this.userData=t.userData),t.vertexColors!==void 0&&(typeof t.vertexColors=="number"?this.vertexColors=t.vertexColors>0:this.vertexColors=t.vertexColors),t.size!==void 0&&(this.size=t.size),t.sizeAttenuation!==void 0&&(this.sizeAttenuation=t.sizeAttenuation),t.map!==void 0&&(this.map=e[t.map]||null),t.matcap!==void 0&&(this.matcap=e[t.matcap]||null),t.alphaMap!==void 0&&(this.alphaMap=e[t.alphaMap]||null),t.bumpMap!==void 0&&(this.bumpMap=e[t.bumpMap]||null),t.bumpScale!==void 0&&(this.bumpScale=t.bumpScale),t.normalMap!==void 0&&(this.normalMap=e[t.normalMap]||null),t.normalMapType!==void 0&&(this.normalMapType=t.normalMapType),t.normalScale!==void 0){let n=t.normalScale;Array.isArray(n)===!1&&(n=[n,n]),this.normalScale=new ee().fromArray(n)}return t.displacementMap!==void 0&&(this.displacementMap=e[t.displacementMap]||null),t.displacementScale!==void 0&&(this.displacementScale=t.displacementScale),t.displacementBias!==void 0&&(this.displacementBias=t.displacementBias),t.roughnessMap!==void 0&&(this.roughnessMap=e[t.roughnessMap]||null),t.metalnessMap!==void 0&&(this.metalnessMap=e[t.metalnessMap]||null),t.emissiveMap!==void 0&&(this.emissiveMap=e[t.emissiveMap]||null),t.emissiveIntensity!==void 0&&(this.emissiveIntensity=t.emissiveIntensity),t.specularMap!==void 0&&(this.specularMap=e[t.specularMap]||null),t.specularIntensityMap!==void 0&&(this.specularIntensityMap=e[t.specularIntensityMap]||null),t.specularColorMap!==void 0&&(this.specularColorMap=e[t.specularColorMap]||null),t.envMap!==void 0&&(this.envMap=e[t.envMap]||null),t.envMapRotation!==void 0&&this.envMapRotation.fromArray(t.envMapRotation),t.envMapIntensity!==void 0&&(this.envMapIntensity=t.envMapIntensity),t.reflectivity!==void 0&&(this.reflectivity=t.reflectivity),t.refractionRatio!==void 0&&(this.refractionRatio=t.refractionRatio),t.lightMap!==void 0&&(this.lightMap=e[t.lightMap]||null),t.lightMapIntensity!==void 0&&(this.lightMapIntensity=t.lightMapIntensity),t.aoMap!==void 0&&(this.aoMap=e[t.aoMap]||null),t.aoMapIntensity!==void 0&&(this.aoMapIntensity=t.aoMapIntensity),t.gradientMap!==void 0&&(this.gradientMap=e[t.gradientMap]||null),t.clearcoatMap!==void 0&&(this.clearcoatMap=e[t.clearcoatMap]||null),t.clearcoatRoughnessMap!==void 0&&(this.clearcoatRoughnessMap=e[t.clearcoatRoughnessMap]||null),t.clearcoatNormalMap!==void 0&&(this.clearcoatNormalMap=e[t.clearcoatNormalMap]||null),t.clearcoatNormalScale!==void 0&&(this.clearcoatNormalScale=new ee().fromArray(t.clearcoatNormalScale)),t.diffuseRoughnessMap!==void 0&&(this.diffuseRoughnessMap=e[t.diffuseRoughnessMap]||null),t.iridescenceMap!==void 0&&(this.iridescenceMap=e[t.iridescenceMap]||null),t.iridescenceThicknessMap!==void 0&&(this.iridescenceThicknessMap=e[t.iridescenceThicknessMap]||null),t.transmissionMap!==void 0&&(this.transmissionMap=e[t.transmissionMap]||null),t.thicknessMap!==void 0&&(this.thicknessMap=e[t.thicknessMap]||null),t.anisotropyMap!==void 0&&(this.anisotropyMap=e[t.anisotropyMap]||null),t.sheenColorMap!==void 0&&(this.sheenColorMap=e[t.sheenColorMap]||null),t.sheenRoughnessMap!==void 0&&(this.sheenRoughnessMap=e[t.sheenRoughnessMap]||null),this}clone(){return new this.constructor().copy(this)}copy(t){this.name=t.name,this.blending=t.blending,this.side=t.side,this.vertexColors=t.vertexColors,this.opacity=t.opacity,this.transparent=t.transparent,this.blendSrc=t.blendSrc,this.blendDst=t.blendDst,this.blendEquation=t.blendEquation,this.blendSrcAlpha=t.blendSrcAlpha,this.blendDstAlpha=t.blendDstAlpha,this.blendEquationAlpha=t.blendEquationAlpha,this.blendColor.copy(t.blendColor),this.blendAlpha=t.blendAlpha,this.depthFunc=t.depthFunc,this.depthTest=t.depthTest,this.depthWrite=t.depthWrite,this.stencilWriteMask=t.stencilWriteMask,this.stencilFunc=t.stencilFunc,this.stencilRef=t.stencilRef,this.stencilFuncMask=t.stencilFuncMask,this.stencilFail=t.stencilFail,this.stencilZFail=t.stencilZFail,this.stencilZPass=t.stencilZPass,this.stencilWrite=t.stencilWrite;const e=t.clippingPlanes;let n=null;if(e!==null){const s=e.length;n=new Array(s);for(let r=0;r!==s;++r)n[r]=e[r].clone()}return this.clippingPlanes=n,this.clipIntersection=t.clipIntersection,this.clipShadows=t.clipShadows,this.shadowSide=t.shadowSide,this.colorWrite=t.colorWrite,this.precision=t.precision,this.polygonOffset=t.polygonOffset,this.polygonOffsetFactor=t.polygonOffsetFactor,this.polygonOffsetUnits=t.polygonOffsetUnits,this.dithering=t.dithering,this.alphaTest=t.alphaTest,this.alphaHash=t.alphaHash,this.alphaToCoverage=t.alphaToCoverage,this.premultipliedAlpha=t.premultipliedAlpha,this.forceSinglePass=t.forceSinglePass,this.allowOverride=t.allowOverride,this.visible=t.visible,this.toneMapped=t.toneMapped,this.userData=JSON.parse(JSON.stringify(t.userData)),this}dispose(){this.dispatchEvent({type:"dispose"})}set needsUpdate(t){t===!0&&this.version++}}const qi=new W,Vl=new W,qa=new W,Ka=new W;class wh{constructor(t=new W,e=new W(0,0,-1)){this.origin=t,this.direction=e}set(t,e){return this.origin.copy(t),this.direction.copy(e),this}copy(t){return this.origin.copy(t.origin),this.direction.copy(t.direction),this}at(t,e){return e.copy(this.origin).addScaledVector(this.direction,t)}lookAt(t){return this.direction.copy(t).sub(this.origin).normalize(),this}recast(t){return this.origin.copy(this.at(t,qi)),this}closestPointToPoint(t,e){e.subVectors(t,this.origin);const n=e.dot(this.direction);return n<0?e.copy(this.origin):e.copy(this.origin).addScaledVector(this.direction,n)}distanceToPoint(t){return Math.sqrt(this.distanceSqToPoint(t))}distanceSqToPoint(t){const e=qi.subVectors(t,this.origin).dot(this.direction);return e<0?this.origin.distanceToSquared(t):(qi.copy(this.origin).addScaledVector(this.direction,e),qi.distanceToSquared(t))}distanceSqToSegment(t,e,n,s){Vl.copy(t).add(e).multiplyScalar(.5),qa.copy(e).sub(t).normalize(),Ka.copy(this.origin).sub(Vl);const r=t.distanceTo(e)*.5,a=-this.direction.dot(qa),o=Ka.dot(this.direction),l=-Ka.dot(qa),c=Ka.lengthSq(),h=Math.abs(1-a*a);let u,f,d,x;if(h>0)if(u=a*l-o,f=a*o-l,x=r*h,u>=0)if(f>=-x)if(f<=x){const v=1/h;u*=v,f*=v,d=u*(u+a*f+2*o)+f*(a*u+f+2*l)+c}else f=r,u=Math.max(0,-(a*f+o)),d=-u*u+f*(f+2*l)+c;else f=-r,u=Math.max(0,-(a*f+o)),d=-u*u+f*(f+2*l)+c;else f<=-x?(u=Math.max(0,-(-a*r+o)),f=u>0?-r:Math.min(Math.max(-r,-l),r),d=-u*u+f*(f+2*l)+c):f<=x?(u=0,f=Math.min(Math.max(-r,-l),r),d=f*(f+2*l)+c):(u=Math.max(0,-(a*r+o)),f=u>0?r:Math.min(Math.max(-r,-l),r),d=-u*u+f*(f+2*l)+c);else f=a>0?-r:r,u=Math.max(0,-(a*f+o)),d=-u*u+f*(f+2*l)+c;return n&&n.copy(this.origin).addScaledVector(this.direction,u),s&&s.copy(Vl).addScaledVector(qa,f),d}intersectSphere(t,e){if(t.radius<0)return null;qi.subVectors(t.center,this.origin);const n=qi.dot(this.direction),s=qi.dot(qi)-n*n,r=t.radius*t.radius;if(s>r)return null;const a=Math.sqrt(r-s),o=n-a,l=n+a;return l<0?null:o<0?this.at(l,e):this.at(o,e)}intersectsSphere(t){return t.radius<0?!1:this.distanceSqToPoint(t.center)<=t.radius*t.radius}distanceToPlane(t){const e=t.normal.dot(this.direction);if(e===0)return t.distanceToPoint(this.origin)===0?0:null;const n=-(this.origin.dot(t.normal)+t.constant)/e;return n>=0?n:null}intersectPlane(t,e){const n=this.distanceToPlane(t);return n===null?null:this.at(n,e)}intersectsPlane(t){const e=t.distanceToPoint(this.origin);return e===0||t.normal.dot(this.direction)*e<0}intersectBox(t,e){let n,s,r,a,o,l;const c=1/this.direction.x,h=1/this.direction.y,u=1/this.direction.z,f=this.origin;return c>=0?(n=(t.min.x-f.x)*c,s=(t.max.x-f.x)*c):(n=(t.max.x-f.x)*c,s=(t.min.x-f.x)*c),h>=0?(r=(t.min.y-f.y)*h,a=(t.max.y-f.y)*h):(r=(t.max.y-f.y)*h,a=(t.min.y-f.y)*h),n>a||r>s||((r>n||isNaN(n))&&(n=r),(a<s||isNaN(s))&&(s=a),u>=0?(o=(t.min.z-f.z)*u,l=(t.max.z-f.z)*u):(o=(t.max.z-f.z)*u,l=(t.min.z-f.z)*u),n>l||o>s)||((o>n||n!==n)&&(n=o),(l<s||s!==s)&&(s=l),s<0)?null:this.at(n>=0?n:s,e)}intersectsBox(t){return this.intersectBox(t,qi)!==null}intersectTriangle(t,e,n,s,r){const a=this.origin,o=this.direction,l=o.x,c=o.y,h=o.z,u=t.x-a.x,f=t.y-a.y,d=t.z-a.z,x=e.x-a.x,v=e.y-a.y,m=e.z-a.z,p=n.x-a.x,S=n.y-a.y,C=n.z-a.z,b=Math.abs(l),P=Math.abs(c),T=Math.abs(h);let _,w,B,I,D,z,V,N,H,K,k,lt;if(b>=P&&b>=T?(B=l,z=u,H=x,lt=p,l>=0?(_=c,w=h,I=f,D=d,V=v,N=m,K=S,k=C):(_=h,w=c,I=d,D=f,V=m,N=v,K=C,k=S)):P>=T?(B=c,z=f,H=v,lt=S,c>=0?(_=h,w=l,I=d,D=u,V=m,N=x,K=C,k=p):(_=l,w=h,I=u,D=d,V=x,N=m,K=p,k=C)):(B=h,z=d,H=m,lt=C,h>=0?(_=l,w=c,I=u,D=f,V=x,N=v,K=p,k=S):(_=c,w=l,I=f,D=u,V=v,N=x,K=S,k=p)),B===0)return null;const Z=_/B,Q=w/B,it=1/B,ut=I-Z*z,ht=D-Q*z,j=V-Z*H,pt=N-Q*H,_t=K-Z*lt,Tt=k-Q*lt,St=_t*pt-Tt*j,Gt=ut*Tt-ht*_t,jt=j*ht-pt*ut;if(s){if(St<0||Gt<0||jt<0)return null}else if((St<0||Gt<0||jt<0)&&(St>0||Gt>0||jt>0))return null;const zt=St+Gt+jt;if(zt===0)return null;const le=it*(St*z+Gt*H+jt*lt);return(zt>0?le<0:le>0)?null:this.at(le/zt,r)}applyMatrix4(t){return this.origin.applyMatrix4(t),this.direction.transformDirection(t),this}equals(t){return t.origin.equals(this.origin)&&t.direction.equals(this.direction)}clone(){return new this.constructor().copy(this)}}class _x extends kr{constructor(t){super(),this.isMeshBasicMaterial=!0,this.type="MeshBasicMaterial",this.color=new se(16777215),this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.specularMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new ws,this.combine=mh,this.reflectivity=1,this.refractionRatio=.98,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap="round",this.wireframeLinejoin="round",this.fog=!0,this.setValues(t)}copy(t){return super.copy(t),this.color.copy(t.color),this.map=t.map,this.lightMap=t.lightMap,this.lightMapIntensity=t.lightMapIntensity,this.aoMap=t.aoMap,this.aoMapIntensity=t.aoMapIntensity,this.specularMap=t.specularMap,this.alphaMap=t.alphaMap,this.envMap=t.envMap,this.envMapRotation.copy(t.envMapRotation),this.combine=t.combine,this.reflectivity=t.reflectivity,this.refractionRatio=t.refractionRatio,this.wireframe=t.wireframe,this.wireframeLinewidth=t.wireframeLinewidth,this.wireframeLinecap=t.wireframeLinecap,this.wireframeLinejoin=t.wireframeLinejoin,this.fog=t.fog,this}}const Mf=new Pe,Ds=new wh,Za=new Or,Sf=new W,Ja=new W,Qa=new W,ja=new W,Wl=new W,to=new W,yf=new W,eo=new W;class ss extends bn{constructor(t=new li,e=new _x){super(),this.isMesh=!0,this.type="Mesh",this.geometry=t,this.material=e,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.count=1,this.updateMorphTargets()}copy(t,e){return super.copy(t,e),t.morphTargetInfluences!==void 0?this.morphTargetInfluences=t.morphTargetInfluences.slice():this.morphTargetInfluences=void 0,t.morphTargetDictionary!==void 0?this.morphTargetDictionary=Object.assign({},t.morphTargetDictionary):this.morphTargetDictionary=void 0,this.material=Array.isArray(t.material)?t.material.slice():t.material,this.geometry=t.geometry,this}updateMorphTargets(){const e=this.geometry.morphAttributes,n=Object.keys(e);if(n.length>0){const s=e[n[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,a=s.length;r<a;r++){const o=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[o]=r}}}}getVertexPosition(t,e){const n=this.geometry,s=n.attributes.position,r=n.morphAttributes.position,a=n.morphTargetsRelative;e.fromBufferAttribute(s,t);const o=this.morphTargetInfluences;if(r&&o){to.set(0,0,0);for(let l=0,c=r.length;l<c;l++){const h=o[l],u=r[l];h!==0&&(Wl.fromBufferAttribute(u,t),a?to.addScaledVector(Wl,h):to.addScaledVector(Wl.sub(e),h))}e.add(to)}return e}intersectsFrustum(t){return t.intersectsObject(this)}raycast(t,e){const n=this.geometry,s=this.material,r=this.matrixWorld;s!==void 0&&(n.boundingSphere===null&&n.computeBoundingSphere(),Za.copy(n.boundingSphere),Za.applyMatrix4(r),Ds.copy(t.ray).recast(t.near),!(Za.containsPoint(Ds.origin)===!1&&(Ds.intersectSphere(Za,Sf)===null||Ds.origin.distanceToSquared(Sf)>(t.far-t.near)**2))&&(Mf.copy(r).invert(),Ds.copy(t.ray).applyMatrix4(Mf),!(n.boundingBox!==null&&Ds.intersectsBox(n.boundingBox)===!1)&&this._computeIntersections(t,e,Ds)))}_computeIntersections(t,e,n){let s;const r=this.geometry,a=this.material,o=r.index,l=r.attributes.position,c=r.attributes.uv,h=r.attributes.uv1,u=r.attributes.normal,f=r.groups,d=r.drawRange;if(o!==null)if(Array.isArray(a))for(let x=0,v=f.length;x<v;x++){const m=f[x],p=a[m.materialIndex],S=Math.max(m.start,d.start),C=Math.min(o.count,Math.min(m.start+m.count,d.start+d.count));for(let b=S,P=C;b<P;b+=3){const T=o.getX(b),_=o.getX(b+1),w=o.getX(b+2);s=no(this,p,t,n,c,h,u,T,_,w),s&&(s.faceIndex=Math.floor(b/3),s.face.materialIndex=m.materialIndex,e.push(s))}}else{const x=Math.max(0,d.start),v=Math.min(o.count,d.start+d.count);for(let m=x,p=v;m<p;m+=3){const S=o.getX(m),C=o.getX(m+1),b=o.getX(m+2);s=no(this,a,t,n,c,h,u,S,C,b),s&&(s.faceIndex=Math.floor(m/3),e.push(s))}}else if(l!==void 0)if(Array.isArray(a))for(let x=0,v=f.length;x<v;x++){const m=f[x],p=a[m.materialIndex],S=Math.max(m.start,d.start),C=Math.min(l.count,Math.min(m.start+m.count,d.start+d.count));for(let b=S,P=C;b<P;b+=3){const T=b,_=b+1,w=b+2;s=no(this,p,t,n,c,h,u,T,_,w),s&&(s.faceIndex=Math.floor(b/3),s.face.materialIndex=m.materialIndex,e.push(s))}}else{const x=Math.max(0,d.start),v=Math.min(l.count,d.start+d.count);for(let m=x,p=v;m<p;m+=3){const S=m,C=m+1,b=m+2;s=no(this,a,t,n,c,h,u,S,C,b),s&&(s.faceIndex=Math.floor(m/3),e.push(s))}}}}function xx(i,t,e,n,s,r,a,o){let l;if(t.side===Vn?l=n.intersectTriangle(a,r,s,!0,o):l=n.intersectTriangle(s,r,a,t.side===Bs,o),l===null)return null;eo.copy(o),eo.applyMatrix4(i.matrixWorld);const c=e.ray.origin.distanceTo(eo);return c<e.near||c>e.far?null:{distance:c,point:eo.clone(),object:i}}function no(i,t,e,n,s,r,a,o,l,c){i.getVertexPosition(o,Ja),i.getVertexPosition(l,Qa),i.getVertexPosition(c,ja);const h=xx(i,t,e,n,Ja,Qa,ja,yf);if(h){const u=new W;vi.getBarycoord(yf,Ja,Qa,ja,u),s&&(h.uv=vi.getInterpolatedAttribute(s,o,l,c,u,new ee)),r&&(h.uv1=vi.getInterpolatedAttribute(r,o,l,c,u,new ee)),a&&(h.normal=vi.getInterpolatedAttribute(a,o,l,c,u,new W),h.normal.dot(n.direction)>0&&h.normal.multiplyScalar(-1));const f={a:o,b:l,c,normal:new W,materialIndex:0};vi.getNormal(Ja,Qa,ja,f.normal),h.face=f,h.barycoord=u}return h}class Lp extends zn{constructor(t=null,e=1,n=1,s,r,a,o,l,c=An,h=An,u,f){super(null,a,o,l,c,h,s,r,u,f),this.isDataTexture=!0,this.image={data:t,width:e,height:n},this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}}class Ef extends Ui{constructor(t,e,n,s=1){super(t,e,n),this.isInstancedBufferAttribute=!0,this.meshPerAttribute=s}copy(t){return super.copy(t),this.meshPerAttribute=t.meshPerAttribute,this}toJSON(){const t=super.toJSON();return t.meshPerAttribute=this.meshPerAttribute,t.isInstancedBufferAttribute=!0,t}}const fr=new Pe,bf=new Pe,io=[],wf=new Vs,vx=new Pe,ia=new ss,sa=new Or;class Dp extends ss{constructor(t,e,n){super(t,e),this.isInstancedMesh=!0,this.instanceMatrix=new Ef(new Float32Array(n*16),16),this.instanceColor=null,this.morphTexture=null,this.count=n,this.boundingBox=null,this.boundingSphere=null;for(let s=0;s<n;s++)this.setMatrixAt(s,vx)}computeBoundingBox(){const t=this.geometry,e=this.count;this.boundingBox===null&&(this.boundingBox=new Vs),t.boundingBox===null&&t.computeBoundingBox(),this.boundingBox.makeEmpty();for(let n=0;n<e;n++)this.getMatrixAt(n,fr),wf.copy(t.boundingBox).applyMatrix4(fr),this.boundingBox.union(wf)}computeBoundingSphere(){const t=this.geometry,e=this.count;this.boundingSphere===null&&(this.boundingSphere=new Or),t.boundingSphere===null&&t.computeBoundingSphere(),this.boundingSphere.makeEmpty();for(let n=0;n<e;n++)this.getMatrixAt(n,fr),sa.copy(t.boundingSphere).applyMatrix4(fr),this.boundingSphere.union(sa)}copy(t,e){return super.copy(t,e),this.instanceMatrix.copy(t.instanceMatrix),this.morphTexture=t.morphTexture!==null?t.morphTexture.clone():null,this.instanceColor=t.instanceColor!==null?t.instanceColor.clone():null,this.count=t.count,this.boundingBox=t.boundingBox!==null?t.boundingBox.clone():null,this.boundingSphere=t.boundingSphere!==null?t.boundingSphere.clone():null,this}getColorAt(t,e){return this.instanceColor===null?e.setRGB(1,1,1):e.fromArray(this.instanceColor.array,t*3)}getMatrixAt(t,e){return e.fromArray(this.instanceMatrix.array,t*16)}getMorphAt(t,e){const n=e.morphTargetInfluences,s=this.morphTexture.source.data.data,r=n.length+1,a=t*r+1;for(let o=0;o<n.length;o++)n[o]=s[a+o]}raycast(t,e){const n=this.matrixWorld,s=this.count;if(ia.geometry=this.geometry,ia.material=this.material,ia.material!==void 0&&(this.boundingSphere===null&&this.computeBoundingSphere(),sa.copy(this.boundingSphere),sa.applyMatrix4(n),t.ray.intersectsSphere(sa)!==!1))for(let r=0;r<s;r++){this.getMatrixAt(r,fr),bf.multiplyMatrices(n,fr),ia.matrixWorld=bf,ia.raycast(t,io);for(let a=0,o=io.length;a<o;a++){const l=io[a];l.instanceId=r,l.object=this,e.push(l)}io.length=0}}setColorAt(t,e){return this.instanceColor===null&&(this.instanceColor=new Ef(new Float32Array(this.instanceMatrix.count*3).fill(1),3)),e.toArray(this.instanceColor.array,t*3),this}setMatrixAt(t,e){return e.toArray(this.instanceMatrix.array,t*16),this}setMorphAt(t,e){const n=e.morphTargetInfluences,s=n.length+1;this.morphTexture===null&&(this.morphTexture=new Lp(new Float32Array(s*this.count),s,this.count,vh,Mi));const r=this.morphTexture.source.data.data;let a=0;for(let c=0;c<n.length;c++)a+=n[c];const o=this.geometry.morphTargetsRelative?1:1-a,l=s*t;return r[l]=o,r.set(n,l+1),this}updateMorphTargets(){}dispose(){super.dispose(),this.instanceMatrix.dispose(),this.instanceColor!==null&&this.instanceColor.dispose(),this.morphTexture!==null&&(this.morphTexture.dispose(),this.morphTexture=null)}}const Ns=new Or,Mx=new ee(.5,.5),so=new W;class wa{constructor(t=new Zi,e=new Zi,n=new Zi,s=new Zi,r=new Zi,a=new Zi){this.planes=[t,e,n,s,r,a]}set(t,e,n,s,r,a){const o=this.planes;return o[0].copy(t),o[1].copy(e),o[2].copy(n),o[3].copy(s),o[4].copy(r),o[5].copy(a),this}copy(t){const e=this.planes;for(let n=0;n<6;n++)e[n].copy(t.planes[n]);return this}setFromProjectionMatrix(t,e=Si,n=!1){const s=this.planes,r=t.elements,a=r[0],o=r[1],l=r[2],c=r[3],h=r[4],u=r[5],f=r[6],d=r[7],x=r[8],v=r[9],m=r[10],p=r[11],S=r[12],C=r[13],b=r[14],P=r[15];if(s[0].setComponents(c-a,d-h,p-x,P-S).normalize(),s[1].setComponents(c+a,d+h,p+x,P+S).normalize(),s[2].setComponents(c+o,d+u,p+v,P+C).normalize(),s[3].setComponents(c-o,d-u,p-v,P-C).normalize(),n)s[4].setComponents(l,f,m,b).normalize(),s[5].setComponents(c-l,d-f,p-m,P-b).normalize();else if(s[4].setComponents(c-l,d-f,p-m,P-b).normalize(),e===Si)s[5].setComponents(c+l,d+f,p+m,P+b).normalize();else if(e===ba)s[5].setComponents(l,f,m,b).normalize();else throw new Error("THREE.Frustum.setFromProjectionMatrix(): Invalid coordinate system: "+e);return this}intersectsObject(t){if(t.boundingSphere!==void 0)t.boundingSphere===null&&t.computeBoundingSphere(),Ns.copy(t.boundingSphere).applyMatrix4(t.matrixWorld);else{const e=t.geometry;e.boundingSphere===null&&e.computeBoundingSphere(),Ns.copy(e.boundingSphere).applyMatrix4(t.matrixWorld)}return this.intersectsSphere(Ns)}intersectsSprite(t){Ns.center.set(0,0,0);const e=Mx.distanceTo(t.center);return Ns.radius=.7071067811865476+e,Ns.applyMatrix4(t.matrixWorld),this.intersectsSphere(Ns)}intersectsSphere(t){const e=this.planes,n=t.center,s=-t.radius;for(let r=0;r<6;r++)if(e[r].distanceToPoint(n)<s)return!1;return!0}intersectsBox(t){const e=this.planes;for(let n=0;n<6;n++){const s=e[n];if(so.x=s.normal.x>0?t.max.x:t.min.x,so.y=s.normal.y>0?t.max.y:t.min.y,so.z=s.normal.z>0?t.max.z:t.min.z,s.distanceToPoint(so)<0)return!1}return!0}containsPoint(t){const e=this.planes;for(let n=0;n<6;n++)if(e[n].distanceToPoint(t)<0)return!1;return!0}clone(){return new this.constructor().copy(this)}}const Tf=new Pe;class Th{constructor(){this.coordinateSystem=Si,this._frustums=[],this._count=0}setFromArrayCamera(t){const e=t.cameras,n=this._frustums;for(let s=0;s<e.length;s++){const r=e[s];Tf.multiplyMatrices(r.projectionMatrix,r.matrixWorldInverse),n[s]===void 0&&(n[s]=new wa),n[s].setFromProjectionMatrix(Tf,r.coordinateSystem,r.reversedDepth)}return this._count=e.length,this}getFrustum(t){return this._frustums[t]}intersectsObject(t){const e=this._frustums;for(let n=0;n<this._count;n++)if(e[n].intersectsObject(t))return!0;return!1}intersectsSprite(t){const e=this._frustums;for(let n=0;n<this._count;n++)if(e[n].intersectsSprite(t))return!0;return!1}intersectsSphere(t){const e=this._frustums;for(let n=0;n<this._count;n++)if(e[n].intersectsSphere(t))return!0;return!1}intersectsBox(t){const e=this._frustums;for(let n=0;n<this._count;n++)if(e[n].intersectsBox(t))return!0;return!1}containsPoint(t){const e=this._frustums;for(let n=0;n<this._count;n++)if(e[n].containsPoint(t))return!0;return!1}copy(t){this.coordinateSystem=t.coordinateSystem;const e=this._frustums,n=t._frustums;for(let s=0;s<t._count;s++)e[s]===void 0&&(e[s]=new wa),e[s].copy(n[s]);return this._count=t._count,this}clone(){return new Th().copy(this)}}class Ah extends kr{constructor(t){super(),this.isLineBasicMaterial=!0,this.type="LineBasicMaterial",this.color=new se(16777215),this.map=null,this.linewidth=1,this.linecap="round",this.linejoin="round",this.fog=!0,this.setValues(t)}copy(t){return super.copy(t),this.color.copy(t.color),this.map=t.map,this.linewidth=t.linewidth,this.linecap=t.linecap,this.linejoin=t.linejoin,this.fog=t.fog,this}}const Fo=new W,Oo=new W,Af=new Pe,ra=new wh,ro=new Or,Xl=new W,Rf=new W;class Sx extends bn{constructor(t=new li,e=new Ah){super(),this.isLine=!0,this.type="Line",this.geometry=t,this.material=e,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.updateMorphTargets()}copy(t,e){return super.copy(t,e),t.morphTargetInfluences!==void 0?this.morphTargetInfluences=t.morphTargetInfluences.slice():this.morphTargetInfluences=void 0,t.morphTargetDictionary!==void 0?this.morphTargetDictionary=Object.assign({},t.morphTargetDictionary):this.morphTargetDictionary=void 0,this.material=Array.isArray(t.material)?t.material.slice():t.material,this.geometry=t.geometry,this}computeLineDistances(){const t=this.geometry;if(t.index===null){const e=t.attributes.position,n=[0];for(let s=1,r=e.count;s<r;s++)Fo.fromBufferAttribute(e,s-1),Oo.fromBufferAttribute(e,s),n[s]=n[s-1],n[s]+=Fo.distanceTo(Oo);t.setAttribute("lineDistance",new wn(n,1))}else Kt("Line.computeLineDistances(): Computation only possible with non-indexed BufferGeometry.");return this}intersectsFrustum(t){return t.intersectsObject(this)}raycast(t,e){const n=this.geometry,s=this.matrixWorld,r=t.params.Line.threshold,a=n.drawRange;if(n.boundingSphere===null&&n.computeBoundingSphere(),ro.copy(n.boundingSphere),ro.applyMatrix4(s),ro.radius+=r,t.ray.intersectsSphere(ro)===!1)return;Af.copy(s).invert(),ra.copy(t.ray).applyMatrix4(Af);const o=r/((this.scale.x+this.scale.y+this.scale.z)/3),l=o*o,c=this.isLineSegments?2:1,h=n.index,f=n.attributes.position;if(h!==null){const d=Math.max(0,a.start),x=Math.min(h.count,a.start+a.count);for(let v=d,m=x-1;v<m;v+=c){const p=h.getX(v),S=h.getX(v+1),C=ao(this,t,ra,l,p,S,v);C&&e.push(C)}if(this.isLineLoop){const v=h.getX(x-1),m=h.getX(d),p=ao(this,t,ra,l,v,m,x-1);p&&e.push(p)}}else{const d=Math.max(0,a.start),x=Math.min(f.count,a.start+a.count);for(let v=d,m=x-1;v<m;v+=c){const p=ao(this,t,ra,l,v,v+1,v);p&&e.push(p)}if(this.isLineLoop){const v=ao(this,t,ra,l,x-1,d,x-1);v&&e.push(v)}}}updateMorphTargets(){const e=this.geometry.morphAttributes,n=Object.keys(e);if(n.length>0){const s=e[n[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,a=s.length;r<a;r++){const o=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[o]=r}}}}}function ao(i,t,e,n,s,r,a){const o=i.geometry.attributes.position;if(Fo.fromBufferAttribute(o,s),Oo.fromBufferAttribute(o,r),e.distanceSqToSegment(Fo,Oo,Xl,Rf)>n)return;Xl.applyMatrix4(i.matrixWorld);const c=t.ray.origin.distanceTo(Xl);if(!(c<t.near||c>t.far))return{distance:c,point:Rf.clone().applyMatrix4(i.matrixWorld),index:a,face:null,faceIndex:null,barycoord:null,object:i}}const Cf=new W,Pf=new W;class Np extends Sx{constructor(t,e){super(t,e),this.isLineSegments=!0,this.type="LineSegments"}computeLineDistances(){const t=this.geometry;if(t.index===null){const e=t.attributes.position,n=[];for(let s=0,r=e.count;s<r;s+=2)Cf.fromBufferAttribute(e,s),Pf.fromBufferAttribute(e,s+1),n[s]=s===0?0:n[s-1],n[s+1]=n[s]+Cf.distanceTo(Pf);t.setAttribute("lineDistance",new wn(n,1))}else Kt("LineSegments.computeLineDistances(): Computation only possible with non-indexed BufferGeometry.");return this}}class Ip extends zn{constructor(t=[],e=Pr,n,s,r,a,o,l,c,h){super(t,e,n,s,r,a,o,l,c,h),this.isCubeTexture=!0,this.flipY=!1}get images(){return this.image}set images(t){this.image=t}}class Dr extends zn{constructor(t,e,n=Fi,s,r,a,o=An,l=An,c,h=bs,u=1){if(h!==bs&&h!==ys)throw new Error("THREE.DepthTexture: format must be either THREE.DepthFormat or THREE.DepthStencilFormat");const f={width:t,height:e,depth:u};super(f,s,r,a,o,l,h,n,c),this.isDepthTexture=!0,this.flipY=!1,this.generateMipmaps=!1,this.compareFunction=null}copy(t){return super.copy(t),this.source=new bh(Object.assign({},t.image)),this.compareFunction=t.compareFunction,this}toJSON(t){const e=super.toJSON(t);return e.compareFunction=this.compareFunction,e}}class Up extends Dr{constructor(t,e=Fi,n=Pr,s,r,a=An,o=An,l,c=bs){const h={width:t,height:t,depth:1},u=[h,h,h,h,h,h];super(t,t,e,n,s,r,a,o,l,c),this.image=u,this.isCubeDepthTexture=!0,this.isCubeTexture=!0}get images(){return this.image}set images(t){this.image=t}}class Fp extends zn{constructor(t=null){super(),this.sourceTexture=t,this.isExternalTexture=!0}copy(t){return super.copy(t),this.sourceTexture=t.sourceTexture,this}}class Aa extends li{constructor(t=1,e=1,n=1,s=1,r=1,a=1){super(),this.type="BoxGeometry",this.parameters={width:t,height:e,depth:n,widthSegments:s,heightSegments:r,depthSegments:a};const o=this;s=Math.floor(s),r=Math.floor(r),a=Math.floor(a);const l=[],c=[],h=[],u=[];let f=0,d=0;x("z","y","x",-1,-1,n,e,t,a,r,0),x("z","y","x",1,-1,n,e,-t,a,r,1),x("x","z","y",1,1,t,n,e,s,a,2),x("x","z","y",1,-1,t,n,-e,s,a,3),x("x","y","z",1,-1,t,e,n,s,r,4),x("x","y","z",-1,-1,t,e,-n,s,r,5),this.setIndex(l),this.setAttribute("position",new wn(c,3)),this.setAttribute("normal",new wn(h,3)),this.setAttribute("uv",new wn(u,2));function x(v,m,p,S,C,b,P,T,_,w,B){const I=b/_,D=P/w,z=b/2,V=P/2,N=T/2,H=_+1,K=w+1;let k=0,lt=0;const Z=new W;for(let Q=0;Q<K;Q++){const it=Q*D-V;for(let ut=0;ut<H;ut++){const ht=ut*I-z;Z[v]=ht*S,Z[m]=it*C,Z[p]=N,c.push(Z.x,Z.y,Z.z),Z[v]=0,Z[m]=0,Z[p]=T>0?1:-1,h.push(Z.x,Z.y,Z.z),u.push(ut/_),u.push(1-Q/w),k+=1}}for(let Q=0;Q<w;Q++)for(let it=0;it<_;it++){const ut=f+it+H*Q,ht=f+it+H*(Q+1),j=f+(it+1)+H*(Q+1),pt=f+(it+1)+H*Q;l.push(ut,ht,pt),l.push(ht,j,pt),lt+=6}o.addGroup(d,lt,B),d+=lt,f+=k}}copy(t){return super.copy(t),this.parameters=Object.assign({},t.parameters),this}static fromJSON(t){return new Aa(t.width,t.height,t.depth,t.widthSegments,t.heightSegments,t.depthSegments)}}class Rh extends li{constructor(t=1,e=1,n=1,s=32,r=1,a=!1,o=0,l=Math.PI*2){super(),this.type="CylinderGeometry",this.parameters={radiusTop:t,radiusBottom:e,height:n,radialSegments:s,heightSegments:r,openEnded:a,thetaStart:o,thetaLength:l};const c=this;s=Math.floor(s),r=Math.floor(r);const h=[],u=[],f=[],d=[];let x=0;const v=[],m=n/2;let p=0;S(),a===!1&&(t>0&&C(!0),e>0&&C(!1)),this.setIndex(h),this.setAttribute("position",new wn(u,3)),this.setAttribute("normal",new wn(f,3)),this.setAttribute("uv",new wn(d,2));function S(){const b=new W,P=new W;let T=0;const _=(e-t)/n;for(let w=0;w<=r;w++){const B=[],I=w/r,D=I*(e-t)+t;for(let z=0;z<=s;z++){const V=z/s,N=V*l+o,H=Math.sin(N),K=Math.cos(N);P.x=D*H,P.y=-I*n+m,P.z=D*K,u.push(P.x,P.y,P.z),b.set(H,_,K).normalize(),f.push(b.x,b.y,b.z),d.push(V,1-I),B.push(x++)}v.push(B)}for(let w=0;w<s;w++)for(let B=0;B<r;B++){const I=v[B][w],D=v[B+1][w],z=v[B+1][w+1],V=v[B][w+1];(t>0||B!==0)&&(h.push(I,D,V),T+=3),(e>0||B!==r-1)&&(h.push(D,z,V),T+=3)}c.addGroup(p,T,0),p+=T}function C(b){const P=x,T=new ee,_=new W;let w=0;const B=b===!0?t:e,I=b===!0?1:-1;for(let z=1;z<=s;z++)u.push(0,m*I,0),f.push(0,I,0),d.push(.5,.5),x++;const D=x;for(let z=0;z<=s;z++){const N=z/s*l+o,H=Math.cos(N),K=Math.sin(N);_.x=B*K,_.y=m*I,_.z=B*H,u.push(_.x,_.y,_.z),f.push(0,I,0),T.x=H*.5+.5,T.y=K*.5*I+.5,d.push(T.x,T.y),x++}for(let z=0;z<s;z++){const V=P+z,N=D+z;b===!0?h.push(N,N+1,V):h.push(N+1,N,V),w+=3}c.addGroup(p,w,b===!0?1:2),p+=w}}copy(t){return super.copy(t),this.parameters=Object.assign({},t.parameters),this}static fromJSON(t){return new Rh(t.radiusTop,t.radiusBottom,t.height,t.radialSegments,t.heightSegments,t.openEnded,t.thetaStart,t.thetaLength)}}class Yo extends li{constructor(t=1,e=1,n=1,s=1){super(),this.type="PlaneGeometry",this.parameters={width:t,height:e,widthSegments:n,heightSegments:s};const r=t/2,a=e/2,o=Math.floor(n),l=Math.floor(s),c=o+1,h=l+1,u=t/o,f=e/l,d=[],x=[],v=[],m=[];for(let p=0;p<h;p++){const S=p*f-a;for(let C=0;C<c;C++){const b=C*u-r;x.push(b,-S,0),v.push(0,0,1),m.push(C/o),m.push(1-p/l)}}for(let p=0;p<l;p++)for(let S=0;S<o;S++){const C=S+c*p,b=S+c*(p+1),P=S+1+c*(p+1),T=S+1+c*p;d.push(C,b,T),d.push(b,P,T)}this.setIndex(d),this.setAttribute("position",new wn(x,3)),this.setAttribute("normal",new wn(v,3)),this.setAttribute("uv",new wn(m,2))}copy(t){return super.copy(t),this.parameters=Object.assign({},t.parameters),this}static fromJSON(t){return new Yo(t.width,t.height,t.widthSegments,t.heightSegments)}}class Ch extends li{constructor(t=1,e=32,n=16,s=0,r=Math.PI*2,a=0,o=Math.PI){super(),this.type="SphereGeometry",this.parameters={radius:t,widthSegments:e,heightSegments:n,phiStart:s,phiLength:r,thetaStart:a,thetaLength:o},e=Math.max(3,Math.floor(e)),n=Math.max(2,Math.floor(n));const l=Math.min(a+o,Math.PI);let c=0;const h=[],u=new W,f=new W,d=[],x=[],v=[],m=[];for(let p=0;p<=n;p++){const S=[],C=p/n,b=a+C*o,P=t*Math.cos(b),T=Math.sqrt(t*t-P*P);let _=0;p===0&&a===0?_=.5/e:p===n&&l===Math.PI&&(_=-.5/e);for(let w=0;w<=e;w++){const B=w/e,I=s+B*r;u.x=-T*Math.cos(I),u.y=P,u.z=T*Math.sin(I),x.push(u.x,u.y,u.z),f.copy(u).normalize(),v.push(f.x,f.y,f.z),m.push(B+_,1-C),S.push(c++)}h.push(S)}for(let p=0;p<n;p++)for(let S=0;S<e;S++){const C=h[p][S+1],b=h[p][S],P=h[p+1][S],T=h[p+1][S+1];(p!==0||a>0)&&d.push(C,b,T),(p!==n-1||l<Math.PI)&&d.push(b,P,T)}this.setIndex(d),this.setAttribute("position",new wn(x,3)),this.setAttribute("normal",new wn(v,3)),this.setAttribute("uv",new wn(m,2))}copy(t){return super.copy(t),this.parameters=Object.assign({},t.parameters),this}static fromJSON(t){return new Ch(t.radius,t.widthSegments,t.heightSegments,t.phiStart,t.phiLength,t.thetaStart,t.thetaLength)}}function Nr(i){const t={};for(const e in i){t[e]={};for(const n in i[e]){const s=i[e][n];if(Lf(s))s.isRenderTargetTexture?(Kt("UniformsUtils: Textures of render targets cannot be cloned via cloneUniforms() or mergeUniforms()."),t[e][n]=null):t[e][n]=s.clone();else if(Array.isArray(s))if(Lf(s[0])){const r=[];for(let a=0,o=s.length;a<o;a++)r[a]=s[a].clone();t[e][n]=r}else t[e][n]=s.slice();else t[e][n]=s}}return t}function kn(i){const t={};for(let e=0;e<i.length;e++){const n=Nr(i[e]);for(const s in n)t[s]=n[s]}return t}function Lf(i){return i&&(i.isColor||i.isMatrix3||i.isMatrix4||i.isVector2||i.isVector3||i.isVector4||i.isTexture||i.isQuaternion)}function yx(i){const t=[];for(let e=0;e<i.length;e++)t.push(i[e].clone());return t}function Op(i){const t=i.getRenderTarget();return t===null?i.outputColorSpace:t.isXRRenderTarget===!0?t.texture.colorSpace:_e.workingColorSpace}const Ex={clone:Nr,merge:kn};var bx=`void main() {
	gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
}`,wx=`void main() {
	gl_FragColor = vec4( 1.0, 0.0, 0.0, 1.0 );
}`;class Hs extends kr{constructor(t){super(),this.isShaderMaterial=!0,this.type="ShaderMaterial",this.defines={},this.uniforms={},this.uniformsGroups=[],this.vertexShader=bx,this.fragmentShader=wx,this.linewidth=1,this.wireframe=!1,this.wireframeLinewidth=1,this.fog=!1,this.lights=!1,this.clipping=!1,this.forceSinglePass=!0,this.extensions={clipCullDistance:!1,multiDraw:!1},this.defaultAttributeValues={color:[1,1,1],uv:[0,0],uv1:[0,0]},this.index0AttributeName=void 0,this.uniformsNeedUpdate=!1,this.glslVersion=null,t!==void 0&&this.setValues(t)}copy(t){return super.copy(t),this.fragmentShader=t.fragmentShader,this.vertexShader=t.vertexShader,this.uniforms=Nr(t.uniforms),this.uniformsGroups=yx(t.uniformsGroups),this.defines=Object.assign({},t.defines),this.wireframe=t.wireframe,this.wireframeLinewidth=t.wireframeLinewidth,this.fog=t.fog,this.lights=t.lights,this.clipping=t.clipping,this.extensions=Object.assign({},t.extensions),this.glslVersion=t.glslVersion,this.defaultAttributeValues=Object.assign({},t.defaultAttributeValues),this.index0AttributeName=t.index0AttributeName,this.uniformsNeedUpdate=t.uniformsNeedUpdate,this}toJSON(t){const e=super.toJSON(t);e.glslVersion=this.glslVersion,e.uniforms={};for(const s in this.uniforms){const a=this.uniforms[s].value;a&&a.isTexture?e.uniforms[s]={type:"t",value:a.toJSON(t).uuid}:a&&a.isColor?e.uniforms[s]={type:"c",value:a.getHex()}:a&&a.isVector2?e.uniforms[s]={type:"v2",value:a.toArray()}:a&&a.isVector3?e.uniforms[s]={type:"v3",value:a.toArray()}:a&&a.isVector4?e.uniforms[s]={type:"v4",value:a.toArray()}:a&&a.isMatrix3?e.uniforms[s]={type:"m3",value:a.toArray()}:a&&a.isMatrix4?e.uniforms[s]={type:"m4",value:a.toArray()}:e.uniforms[s]={value:a}}Object.keys(this.defines).length>0&&(e.defines=this.defines),e.vertexShader=this.vertexShader,e.fragmentShader=this.fragmentShader,e.lights=this.lights,e.clipping=this.clipping;const n={};for(const s in this.extensions)this.extensions[s]===!0&&(n[s]=!0);return Object.keys(n).length>0&&(e.extensions=n),e}fromJSON(t,e){if(super.fromJSON(t,e),t.uniforms!==void 0)for(const n in t.uniforms){const s=t.uniforms[n];switch(this.uniforms[n]={},s.type){case"t":this.uniforms[n].value=e[s.value]||null;break;case"c":this.uniforms[n].value=new se().setHex(s.value);break;case"v2":this.uniforms[n].value=new ee().fromArray(s.value);break;case"v3":this.uniforms[n].value=new W().fromArray(s.value);break;case"v4":this.uniforms[n].value=new je().fromArray(s.value);break;case"m3":this.uniforms[n].value=new ne().fromArray(s.value);break;case"m4":this.uniforms[n].value=new Pe().fromArray(s.value);break;default:this.uniforms[n].value=s.value}}if(t.defines!==void 0&&(this.defines=t.defines),t.vertexShader!==void 0&&(this.vertexShader=t.vertexShader),t.fragmentShader!==void 0&&(this.fragmentShader=t.fragmentShader),t.glslVersion!==void 0&&(this.glslVersion=t.glslVersion),t.extensions!==void 0)for(const n in t.extensions)this.extensions[n]=t.extensions[n];return t.lights!==void 0&&(this.lights=t.lights),t.clipping!==void 0&&(this.clipping=t.clipping),this}}class Tx extends Hs{constructor(t){super(t),this.isRawShaderMaterial=!0,this.type="RawShaderMaterial"}}class kp extends kr{constructor(t){super(),this.isMeshLambertMaterial=!0,this.type="MeshLambertMaterial",this.color=new se(16777215),this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.emissive=new se(0),this.emissiveIntensity=1,this.emissiveMap=null,this.bumpMap=null,this.bumpScale=1,this.normalMap=null,this.normalMapType=Kc,this.normalScale=new ee(1,1),this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.specularMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new ws,this.combine=mh,this.reflectivity=1,this.envMapIntensity=1,this.refractionRatio=.98,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap="round",this.wireframeLinejoin="round",this.flatShading=!1,this.fog=!0,this.setValues(t)}copy(t){return super.copy(t),this.color.copy(t.color),this.map=t.map,this.lightMap=t.lightMap,this.lightMapIntensity=t.lightMapIntensity,this.aoMap=t.aoMap,this.aoMapIntensity=t.aoMapIntensity,this.emissive.copy(t.emissive),this.emissiveMap=t.emissiveMap,this.emissiveIntensity=t.emissiveIntensity,this.bumpMap=t.bumpMap,this.bumpScale=t.bumpScale,this.normalMap=t.normalMap,this.normalMapType=t.normalMapType,this.normalScale.copy(t.normalScale),this.displacementMap=t.displacementMap,this.displacementScale=t.displacementScale,this.displacementBias=t.displacementBias,this.specularMap=t.specularMap,this.alphaMap=t.alphaMap,this.envMap=t.envMap,this.envMapRotation.copy(t.envMapRotation),this.combine=t.combine,this.reflectivity=t.reflectivity,this.envMapIntensity=t.envMapIntensity,this.refractionRatio=t.refractionRatio,this.wireframe=t.wireframe,this.wireframeLinewidth=t.wireframeLinewidth,this.wireframeLinecap=t.wireframeLinecap,this.wireframeLinejoin=t.wireframeLinejoin,this.flatShading=t.flatShading,this.fog=t.fog,this}}class Ax extends kr{constructor(t){super(),this.isMeshDepthMaterial=!0,this.type="MeshDepthMaterial",this.depthPacking=N0,this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.wireframe=!1,this.wireframeLinewidth=1,this.setValues(t)}copy(t){return super.copy(t),this.depthPacking=t.depthPacking,this.map=t.map,this.alphaMap=t.alphaMap,this.displacementMap=t.displacementMap,this.displacementScale=t.displacementScale,this.displacementBias=t.displacementBias,this.wireframe=t.wireframe,this.wireframeLinewidth=t.wireframeLinewidth,this}}class Rx extends kr{constructor(t){super(),this.isMeshDistanceMaterial=!0,this.type="MeshDistanceMaterial",this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.setValues(t)}copy(t){return super.copy(t),this.map=t.map,this.alphaMap=t.alphaMap,this.displacementMap=t.displacementMap,this.displacementScale=t.displacementScale,this.displacementBias=t.displacementBias,this}}class Bp extends bn{static registerNode(t){this.prototype._lightNode=t}constructor(t,e=1){super(),this.isLight=!0,this.type="Light",this.color=new se(t),this.intensity=e}copy(t,e){return super.copy(t,e),this.color.copy(t.color),this.intensity=t.intensity,this}toJSON(t){const e=super.toJSON(t);return e.object.color=this.color.getHex(),e.object.intensity=this.intensity,e}}class Cx extends Bp{constructor(t,e,n){super(t,n),this.isHemisphereLight=!0,this.type="HemisphereLight",this.position.copy(bn.DEFAULT_UP),this.updateMatrix(),this.groundColor=new se(e)}copy(t,e){return super.copy(t,e),this.groundColor.copy(t.groundColor),this}toJSON(t){const e=super.toJSON(t);return e.object.groundColor=this.groundColor.getHex(),e}}const $l=new Pe,Df=new W,Nf=new W;class Px{constructor(t){this.camera=t,this.intensity=1,this.bias=0,this.biasNode=null,this.normalBias=0,this.radius=1,this.blurSamples=8,this.mapSize=new ee(512,512),this.mapType=jn,this.map=null,this.mapPass=null,this.matrix=new Pe,this.autoUpdate=!0,this.needsUpdate=!1,this._frustum=new wa,this._frameExtents=new ee(1,1),this._viewportCount=1,this._viewports=[new je(0,0,1,1)]}getViewportCount(){return this._viewportCount}getCamera(){return this.camera}getFrustum(){return this._frustum}updateMatrices(t){const e=this.camera;Df.setFromMatrixPosition(t.matrixWorld),e.position.copy(Df),Nf.setFromMatrixPosition(t.target.matrixWorld),e.lookAt(Nf),e.updateMatrixWorld(),this._updateMatrix(e,this.matrix,this._frustum)}_updateMatrix(t,e,n,s){$l.multiplyMatrices(t.projectionMatrix,t.matrixWorldInverse),n.setFromProjectionMatrix($l,t.coordinateSystem,t.reversedDepth);const r=this._frameExtents,a=s?s.z/r.x:1,o=s?s.w/r.y:1,l=s?s.x/r.x:0,c=s?s.y/r.y:0;t.coordinateSystem===ba||t.reversedDepth?e.set(.5*a,0,0,.5*a+l,0,.5*o,0,.5*o+c,0,0,1,0,0,0,0,1):e.set(.5*a,0,0,.5*a+l,0,.5*o,0,.5*o+c,0,0,.5,.5,0,0,0,1),e.multiply($l)}getViewport(t){return this._viewports[t]}getFrameExtents(){return this._frameExtents}dispose(){this.map&&this.map.dispose(),this.mapPass&&this.mapPass.dispose()}copy(t){return this.camera=t.camera.clone(),this.intensity=t.intensity,this.bias=t.bias,this.radius=t.radius,this.autoUpdate=t.autoUpdate,this.needsUpdate=t.needsUpdate,this.normalBias=t.normalBias,this.blurSamples=t.blurSamples,this.mapSize.copy(t.mapSize),this.mapType=t.mapType,this.biasNode=t.biasNode,this}clone(){return new this.constructor().copy(this)}toJSON(){const t={};return t.intensity=this.intensity,t.bias=this.bias,t.normalBias=this.normalBias,t.radius=this.radius,t.blurSamples=this.blurSamples,t.mapSize=this.mapSize.toArray(),t.mapType=this.mapType,t.camera=this.camera.toJSON(!1).object,delete t.camera.matrix,t}}const oo=new W,lo=new ki,Pi=new W;class zp extends bn{constructor(){super(),this.isCamera=!0,this.type="Camera",this.matrixWorldInverse=new Pe,this.projectionMatrix=new Pe,this.projectionMatrixInverse=new Pe,this.coordinateSystem=Si,this._reversedDepth=!1}get reversedDepth(){return this._reversedDepth}copy(t,e){return super.copy(t,e),this.matrixWorldInverse.copy(t.matrixWorldInverse),this.projectionMatrix.copy(t.projectionMatrix),this.projectionMatrixInverse.copy(t.projectionMatrixInverse),this.coordinateSystem=t.coordinateSystem,this}getWorldDirection(t){return super.getWorldDirection(t).negate()}updateMatrixWorld(t){super.updateMatrixWorld(t),this.matrixWorld.decompose(oo,lo,Pi),Pi.x===1&&Pi.y===1&&Pi.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(oo,lo,Pi.set(1,1,1)).invert()}updateWorldMatrix(t,e,n=!1){super.updateWorldMatrix(t,e,n),this.matrixWorld.decompose(oo,lo,Pi),Pi.x===1&&Pi.y===1&&Pi.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(oo,lo,Pi.set(1,1,1)).invert()}clone(){return new this.constructor().copy(this)}}const gs=new W,If=new ee,Uf=new ee;class _i extends zp{constructor(t=50,e=1,n=.1,s=2e3){super(),this.isPerspectiveCamera=!0,this.type="PerspectiveCamera",this.fov=t,this.zoom=1,this.near=n,this.far=s,this.focus=10,this.aspect=e,this.view=null,this.filmGauge=35,this.filmOffset=0,this.updateProjectionMatrix()}copy(t,e){return super.copy(t,e),this.fov=t.fov,this.zoom=t.zoom,this.near=t.near,this.far=t.far,this.focus=t.focus,this.aspect=t.aspect,this.view=t.view===null?null:Object.assign({},t.view),this.filmGauge=t.filmGauge,this.filmOffset=t.filmOffset,this}setFocalLength(t){const e=.5*this.getFilmHeight()/t;this.fov=Zc*2*Math.atan(e),this.updateProjectionMatrix()}getFocalLength(){const t=Math.tan(bo*.5*this.fov);return .5*this.getFilmHeight()/t}getEffectiveFOV(){return Zc*2*Math.atan(Math.tan(bo*.5*this.fov)/this.zoom)}getFilmWidth(){return this.filmGauge*Math.min(this.aspect,1)}getFilmHeight(){return this.filmGauge/Math.max(this.aspect,1)}getViewBounds(t,e,n){gs.set(-1,-1,.5).applyMatrix4(this.projectionMatrixInverse),e.set(gs.x,gs.y).multiplyScalar(-t/gs.z),gs.set(1,1,.5).applyMatrix4(this.projectionMatrixInverse),n.set(gs.x,gs.y).multiplyScalar(-t/gs.z)}getViewSize(t,e){return this.getViewBounds(t,If,Uf),e.subVectors(Uf,If)}setViewOffset(t,e,n,s,r,a){this.aspect=t/e,this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=t,this.view.fullHeight=e,this.view.offsetX=n,this.view.offsetY=s,this.view.width=r,this.view.height=a,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){const t=this.near;let e=t*Math.tan(bo*.5*this.fov)/this.zoom,n=2*e,s=this.aspect*n,r=-.5*s;const a=this.view;if(this.view!==null&&this.view.enabled){const l=a.fullWidth,c=a.fullHeight;r+=a.offsetX*s/l,e-=a.offsetY*n/c,s*=a.width/l,n*=a.height/c}const o=this.filmOffset;o!==0&&(r+=t*o/this.getFilmWidth()),this.projectionMatrix.makePerspective(r,r+s,e,e-n,t,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(t){const e=super.toJSON(t);return e.object.fov=this.fov,e.object.zoom=this.zoom,e.object.near=this.near,e.object.far=this.far,e.object.focus=this.focus,e.object.aspect=this.aspect,this.view!==null&&(e.object.view=Object.assign({},this.view)),e.object.filmGauge=this.filmGauge,e.object.filmOffset=this.filmOffset,e}}class Hp extends zp{constructor(t=-1,e=1,n=1,s=-1,r=.1,a=2e3){super(),this.isOrthographicCamera=!0,this.type="OrthographicCamera",this.zoom=1,this.view=null,this.left=t,this.right=e,this.top=n,this.bottom=s,this.near=r,this.far=a,this.updateProjectionMatrix()}copy(t,e){return super.copy(t,e),this.left=t.left,this.right=t.right,this.top=t.top,this.bottom=t.bottom,this.near=t.near,this.far=t.far,this.zoom=t.zoom,this.view=t.view===null?null:Object.assign({},t.view),this}setViewOffset(t,e,n,s,r,a){this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=t,this.view.fullHeight=e,this.view.offsetX=n,this.view.offsetY=s,this.view.width=r,this.view.height=a,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){const t=(this.right-this.left)/(2*this.zoom),e=(this.top-this.bottom)/(2*this.zoom),n=(this.right+this.left)/2,s=(this.top+this.bottom)/2;let r=n-t,a=n+t,o=s+e,l=s-e;if(this.view!==null&&this.view.enabled){const c=(this.right-this.left)/this.view.fullWidth/this.zoom,h=(this.top-this.bottom)/this.view.fullHeight/this.zoom;r+=c*this.view.offsetX,a=r+c*this.view.width,o-=h*this.view.offsetY,l=o-h*this.view.height}this.projectionMatrix.makeOrthographic(r,a,o,l,this.near,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(t){const e=super.toJSON(t);return e.object.zoom=this.zoom,e.object.left=this.left,e.object.right=this.right,e.object.top=this.top,e.object.bottom=this.bottom,e.object.near=this.near,e.object.far=this.far,this.view!==null&&(e.object.view=Object.assign({},this.view)),e}}class Lx extends Px{constructor(){super(new Hp(-5,5,5,-5,.5,500)),this.isDirectionalLightShadow=!0}}class Dx extends Bp{constructor(t,e){super(t,e),this.isDirectionalLight=!0,this.type="DirectionalLight",this.position.copy(bn.DEFAULT_UP),this.updateMatrix(),this.target=new bn,this.shadow=new Lx}dispose(){super.dispose(),this.shadow.dispose()}copy(t){return super.copy(t),this.target=t.target.clone(),this.shadow=t.shadow.clone(),this}toJSON(t){const e=super.toJSON(t);return e.object.shadow=this.shadow.toJSON(),e.object.target=this.target.uuid,e}}const dr=-90,pr=1;class Jc extends bn{constructor(t,e,n){super(),this.type="CubeCamera",this.renderTarget=n,this.coordinateSystem=null,this.activeMipmapLevel=0;const s=new _i(dr,pr,t,e);s.layers=this.layers,this.add(s);const r=new _i(dr,pr,t,e);r.layers=this.layers,this.add(r);const a=new _i(dr,pr,t,e);a.layers=this.layers,this.add(a);const o=new _i(dr,pr,t,e);o.layers=this.layers,this.add(o);const l=new _i(dr,pr,t,e);l.layers=this.layers,this.add(l);const c=new _i(dr,pr,t,e);c.layers=this.layers,this.add(c)}updateCoordinateSystem(){const t=this.coordinateSystem,e=this.children.concat(),[n,s,r,a,o,l]=e;for(const c of e)this.remove(c);if(t===Si)n.up.set(0,1,0),n.lookAt(1,0,0),s.up.set(0,1,0),s.lookAt(-1,0,0),r.up.set(0,0,-1),r.lookAt(0,1,0),a.up.set(0,0,1),a.lookAt(0,-1,0),o.up.set(0,1,0),o.lookAt(0,0,1),l.up.set(0,1,0),l.lookAt(0,0,-1);else if(t===ba)n.up.set(0,-1,0),n.lookAt(-1,0,0),s.up.set(0,-1,0),s.lookAt(1,0,0),r.up.set(0,0,1),r.lookAt(0,1,0),a.up.set(0,0,-1),a.lookAt(0,-1,0),o.up.set(0,-1,0),o.lookAt(0,0,1),l.up.set(0,-1,0),l.lookAt(0,0,-1);else throw new Error("THREE.CubeCamera.updateCoordinateSystem(): Invalid coordinate system: "+t);for(const c of e)this.add(c),c.updateMatrixWorld()}update(t,e){this.parent===null&&this.updateMatrixWorld();const{renderTarget:n,activeMipmapLevel:s}=this;this.coordinateSystem!==t.coordinateSystem&&(this.coordinateSystem=t.coordinateSystem,this.updateCoordinateSystem());const[r,a,o,l,c,h]=this.children,u=t.getRenderTarget(),f=t.getActiveCubeFace(),d=t.getActiveMipmapLevel(),x=t.xr.enabled;t.xr.enabled=!1;const v=n.texture.mipmapsAutoUpdate;n.texture.mipmapsAutoUpdate=!1;let m=!1;t.isWebGLRenderer===!0?m=t.state.buffers.depth.getReversed():m=t.reversedDepthBuffer,t.setRenderTarget(n,0,s),m&&t.autoClear===!1&&t.clearDepth(),t.render(e,r),t.setRenderTarget(n,1,s),m&&t.autoClear===!1&&t.clearDepth(),t.render(e,a),t.setRenderTarget(n,2,s),m&&t.autoClear===!1&&t.clearDepth(),t.render(e,o),t.setRenderTarget(n,3,s),m&&t.autoClear===!1&&t.clearDepth(),t.render(e,l),t.setRenderTarget(n,4,s),m&&t.autoClear===!1&&t.clearDepth(),t.render(e,c),n.texture.mipmapsAutoUpdate=v,t.setRenderTarget(n,5,s),m&&t.autoClear===!1&&t.clearDepth(),t.render(e,h),t.setRenderTarget(u,f,d),t.xr.enabled=x,n.texture.needsPMREMUpdate=!0}}class Nx extends _i{constructor(t=[]){super(),this.isArrayCamera=!0,this.isMultiViewCamera=!1,this.cameras=t,this.perCameraFrustumCulled=!1}}class Ff{constructor(t=1,e=0,n=0){this.radius=t,this.phi=e,this.theta=n}set(t,e,n){return this.radius=t,this.phi=e,this.theta=n,this}copy(t){return this.radius=t.radius,this.phi=t.phi,this.theta=t.theta,this}makeSafe(){return this.phi=fe(this.phi,1e-6,Math.PI-1e-6),this}setFromVector3(t){return this.setFromCartesianCoords(t.x,t.y,t.z)}setFromCartesianCoords(t,e,n){return this.radius=Math.sqrt(t*t+e*e+n*n),this.radius===0?(this.theta=0,this.phi=0):(this.theta=Math.atan2(t,n),this.phi=Math.acos(fe(e/this.radius,-1,1))),this}clone(){return new this.constructor().copy(this)}}class Ix extends Ts{constructor(t,e=null){super(),this.object=t,this.domElement=e,this.enabled=!0,this.state=-1,this.keys={},this.mouseButtons={LEFT:null,MIDDLE:null,RIGHT:null},this.touches={ONE:null,TWO:null}}connect(t){this.domElement!==null&&this.disconnect(),this.domElement=t}disconnect(){}dispose(){}update(){}}function Of(i,t,e,n){const s=Ux(n);switch(e){case Mp:return i*t;case vh:return i*t/s.components*s.byteLength;case Mh:return i*t/s.components*s.byteLength;case zs:return i*t*2/s.components*s.byteLength;case Sh:return i*t*2/s.components*s.byteLength;case Sp:return i*t*3/s.components*s.byteLength;case Ni:return i*t*4/s.components*s.byteLength;case yh:return i*t*4/s.components*s.byteLength;case vo:case Mo:return Math.floor((i+3)/4)*Math.floor((t+3)/4)*8;case So:case yo:return Math.floor((i+3)/4)*Math.floor((t+3)/4)*16;case Mc:case yc:return Math.max(i,16)*Math.max(t,8)/4;case vc:case Sc:return Math.max(i,8)*Math.max(t,8)/2;case Ec:case bc:case Tc:case Ac:return Math.floor((i+3)/4)*Math.floor((t+3)/4)*8;case wc:case Po:case Rc:return Math.floor((i+3)/4)*Math.floor((t+3)/4)*16;case Cc:return Math.floor((i+3)/4)*Math.floor((t+3)/4)*16;case Pc:return Math.floor((i+4)/5)*Math.floor((t+3)/4)*16;case Lc:return Math.floor((i+4)/5)*Math.floor((t+4)/5)*16;case Dc:return Math.floor((i+5)/6)*Math.floor((t+4)/5)*16;case Nc:return Math.floor((i+5)/6)*Math.floor((t+5)/6)*16;case Ic:return Math.floor((i+7)/8)*Math.floor((t+4)/5)*16;case Uc:return Math.floor((i+7)/8)*Math.floor((t+5)/6)*16;case Fc:return Math.floor((i+7)/8)*Math.floor((t+7)/8)*16;case Oc:return Math.floor((i+9)/10)*Math.floor((t+4)/5)*16;case kc:return Math.floor((i+9)/10)*Math.floor((t+5)/6)*16;case Bc:return Math.floor((i+9)/10)*Math.floor((t+7)/8)*16;case zc:return Math.floor((i+9)/10)*Math.floor((t+9)/10)*16;case Hc:return Math.floor((i+11)/12)*Math.floor((t+9)/10)*16;case Gc:return Math.floor((i+11)/12)*Math.floor((t+11)/12)*16;case Vc:case Wc:case Xc:return Math.ceil(i/4)*Math.ceil(t/4)*16;case $c:case Yc:return Math.ceil(i/4)*Math.ceil(t/4)*8;case Lo:case qc:return Math.ceil(i/4)*Math.ceil(t/4)*16}throw new Error(`Unable to determine texture byte length for ${e} format.`)}function Ux(i){switch(i){case jn:case gp:return{byteLength:1,components:1};case Ea:case _p:case Oi:return{byteLength:2,components:1};case _h:case xh:return{byteLength:2,components:4};case Fi:case gh:case Mi:return{byteLength:4,components:1};case xp:case vp:return{byteLength:4,components:3}}throw new Error(`THREE.TextureUtils: Unknown texture type ${i}.`)}typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("register",{detail:{revision:ph}}));typeof window<"u"&&(window.__THREE__?Kt("WARNING: Multiple instances of Three.js being imported."):window.__THREE__=ph);/**
 * @license
 * Copyright 2010-2026 Three.js Authors
 * SPDX-License-Identifier: MIT
 */function Gp(){let i=null,t=!1,e=null,n=null;function s(r,a){n=i.requestAnimationFrame(s),e(r,a)}return{start:function(){t!==!0&&e!==null&&i!==null&&(n=i.requestAnimationFrame(s),t=!0)},stop:function(){i!==null&&i.cancelAnimationFrame(n),t=!1},setAnimationLoop:function(r){e=r},setContext:function(r){i=r}}}function Fx(i){const t=new WeakMap;function e(o,l){const c=o.array,h=o.usage,u=c.byteLength,f=i.createBuffer();i.bindBuffer(l,f),i.bufferData(l,c,h),o.onUploadCallback();let d;if(c instanceof Float32Array)d=i.FLOAT;else if(typeof Float16Array<"u"&&c instanceof Float16Array)d=i.HALF_FLOAT;else if(c instanceof Uint16Array)o.isFloat16BufferAttribute?d=i.HALF_FLOAT:d=i.UNSIGNED_SHORT;else if(c instanceof Int16Array)d=i.SHORT;else if(c instanceof Uint32Array)d=i.UNSIGNED_INT;else if(c instanceof Int32Array)d=i.INT;else if(c instanceof Int8Array)d=i.BYTE;else if(c instanceof Uint8Array)d=i.UNSIGNED_BYTE;else if(c instanceof Uint8ClampedArray)d=i.UNSIGNED_BYTE;else throw new Error("THREE.WebGLAttributes: Unsupported buffer data format: "+c);return{buffer:f,type:d,bytesPerElement:c.BYTES_PER_ELEMENT,version:o.version,size:u}}function n(o,l,c){const h=l.array,u=l.updateRanges;if(i.bindBuffer(c,o),u.length===0)i.bufferSubData(c,0,h);else{u.sort((d,x)=>d.start-x.start);let f=0;for(let d=1;d<u.length;d++){const x=u[f],v=u[d];v.start<=x.start+x.count+1?x.count=Math.max(x.count,v.start+v.count-x.start):(++f,u[f]=v)}u.length=f+1;for(let d=0,x=u.length;d<x;d++){const v=u[d];i.bufferSubData(c,v.start*h.BYTES_PER_ELEMENT,h,v.start,v.count)}l.clearUpdateRanges()}l.onUploadCallback()}function s(o){return o.isInterleavedBufferAttribute&&(o=o.data),t.get(o)}function r(o){o.isInterleavedBufferAttribute&&(o=o.data);const l=t.get(o);l&&(i.deleteBuffer(l.buffer),t.delete(o))}function a(o,l){if(o.isInterleavedBufferAttribute&&(o=o.data),o.isGLBufferAttribute){const h=t.get(o);(!h||h.version<o.version)&&t.set(o,{buffer:o.buffer,type:o.type,bytesPerElement:o.elementSize,version:o.version});return}const c=t.get(o);if(c===void 0)t.set(o,e(o,l));else if(c.version<o.version){if(c.size!==o.array.byteLength)throw new Error("THREE.WebGLAttributes: The size of the buffer attribute's array buffer does not match the original size. Resizing buffer attributes is not supported.");n(c.buffer,o,l),c.version=o.version}}return{get:s,remove:r,update:a}}var Ox=`#ifdef USE_ALPHAHASH
	if ( diffuseColor.a < getAlphaHashThreshold( vPosition ) ) discard;
#endif`,kx=`#ifdef USE_ALPHAHASH
	const float ALPHA_HASH_SCALE = 0.05;
	float hash2D( vec2 value ) {
		return fract( 1.0e4 * sin( 17.0 * value.x + 0.1 * value.y ) * ( 0.1 + abs( sin( 13.0 * value.y + value.x ) ) ) );
	}
	float hash3D( vec3 value ) {
		return hash2D( vec2( hash2D( value.xy ), value.z ) );
	}
	float getAlphaHashThreshold( vec3 position ) {
		float maxDeriv = max(
			length( dFdx( position.xyz ) ),
			length( dFdy( position.xyz ) )
		);
		float pixScale = 1.0 / ( ALPHA_HASH_SCALE * maxDeriv );
		vec2 pixScales = vec2(
			exp2( floor( log2( pixScale ) ) ),
			exp2( ceil( log2( pixScale ) ) )
		);
		vec2 alpha = vec2(
			hash3D( floor( pixScales.x * position.xyz ) ),
			hash3D( floor( pixScales.y * position.xyz ) )
		);
		float lerpFactor = fract( log2( pixScale ) );
		float x = ( 1.0 - lerpFactor ) * alpha.x + lerpFactor * alpha.y;
		float a = min( lerpFactor, 1.0 - lerpFactor );
		vec3 cases = vec3(
			x * x / ( 2.0 * a * ( 1.0 - a ) ),
			( x - 0.5 * a ) / ( 1.0 - a ),
			1.0 - ( ( 1.0 - x ) * ( 1.0 - x ) / ( 2.0 * a * ( 1.0 - a ) ) )
		);
		float threshold = ( x < ( 1.0 - a ) )
			? ( ( x < a ) ? cases.x : cases.y )
			: cases.z;
		return clamp( threshold , 1.0e-6, 1.0 );
	}
#endif`,Bx=`#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, vAlphaMapUv ).g;
#endif`,zx=`#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,Hx=`#ifdef USE_ALPHATEST
	#ifdef ALPHA_TO_COVERAGE
	diffuseColor.a = smoothstep( alphaTest, alphaTest + fwidth( diffuseColor.a ), diffuseColor.a );
	if ( diffuseColor.a == 0.0 ) discard;
	#else
	if ( diffuseColor.a < alphaTest ) discard;
	#endif
#endif`,Gx=`#ifdef USE_ALPHATEST
	uniform float alphaTest;
#endif`,Vx=`#ifdef USE_AOMAP
	float ambientOcclusion = ( texture2D( aoMap, vAoMapUv ).r - 1.0 ) * aoMapIntensity + 1.0;
	reflectedLight.indirectDiffuse *= ambientOcclusion;
	#if defined( USE_CLEARCOAT ) 
		clearcoatSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_SHEEN ) 
		sheenSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_ENVMAP ) && defined( STANDARD )
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		reflectedLight.indirectSpecular *= computeSpecularOcclusion( dotNV, ambientOcclusion, material.roughness );
	#endif
#endif`,Wx=`#ifdef USE_AOMAP
	uniform sampler2D aoMap;
	uniform float aoMapIntensity;
#endif`,Xx=`#ifdef USE_BATCHING
	#if ! defined( GL_ANGLE_multi_draw )
	#define gl_DrawID _gl_DrawID
	uniform int _gl_DrawID;
	#endif
	uniform highp sampler2D batchingTexture;
	uniform highp usampler2D batchingIdTexture;
	mat4 getBatchingMatrix( const in float i ) {
		int size = textureSize( batchingTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( batchingTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( batchingTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( batchingTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( batchingTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
	float getIndirectIndex( const in int i ) {
		int size = textureSize( batchingIdTexture, 0 ).x;
		int x = i % size;
		int y = i / size;
		return float( texelFetch( batchingIdTexture, ivec2( x, y ), 0 ).r );
	}
#endif
#ifdef USE_BATCHING_COLOR
	uniform sampler2D batchingColorTexture;
	vec4 getBatchingColor( const in float i ) {
		int size = textureSize( batchingColorTexture, 0 ).x;
		int j = int( i );
		int x = j % size;
		int y = j / size;
		return texelFetch( batchingColorTexture, ivec2( x, y ), 0 );
	}
#endif`,$x=`#ifdef USE_BATCHING
	mat4 batchingMatrix = getBatchingMatrix( getIndirectIndex( gl_DrawID ) );
#endif`,Yx=`vec3 transformed = vec3( position );
#ifdef USE_ALPHAHASH
	vPosition = vec3( position );
#endif`,qx=`vec3 objectNormal = vec3( normal );
#ifdef USE_TANGENT
	vec3 objectTangent = vec3( tangent.xyz );
#endif`,Kx=`float G_BlinnPhong_Implicit( ) {
	return 0.25;
}
float D_BlinnPhong( const in float shininess, const in float dotNH ) {
	return RECIPROCAL_PI * ( shininess * 0.5 + 1.0 ) * pow( dotNH, shininess );
}
vec3 BRDF_BlinnPhong( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 specularColor, const in float shininess ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( specularColor, 1.0, dotVH );
	float G = G_BlinnPhong_Implicit( );
	float D = D_BlinnPhong( shininess, dotNH );
	return F * ( G * D );
} // validated`,Zx=`#ifdef USE_IRIDESCENCE
	const mat3 XYZ_TO_REC709 = mat3(
		 3.2404542, -0.9692660,  0.0556434,
		-1.5371385,  1.8760108, -0.2040259,
		-0.4985314,  0.0415560,  1.0572252
	);
	vec3 Fresnel0ToIor( vec3 fresnel0 ) {
		vec3 sqrtF0 = sqrt( fresnel0 );
		return ( vec3( 1.0 ) + sqrtF0 ) / ( vec3( 1.0 ) - sqrtF0 );
	}
	vec3 IorToFresnel0( vec3 transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - vec3( incidentIor ) ) / ( transmittedIor + vec3( incidentIor ) ) );
	}
	float IorToFresnel0( float transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - incidentIor ) / ( transmittedIor + incidentIor ));
	}
	vec3 evalSensitivity( float OPD, vec3 shift ) {
		float phase = 2.0 * PI * OPD * 1.0e-9;
		vec3 val = vec3( 5.4856e-13, 4.4201e-13, 5.2481e-13 );
		vec3 pos = vec3( 1.6810e+06, 1.7953e+06, 2.2084e+06 );
		vec3 var = vec3( 4.3278e+09, 9.3046e+09, 6.6121e+09 );
		vec3 xyz = val * sqrt( 2.0 * PI * var ) * cos( pos * phase + shift ) * exp( - pow2( phase ) * var );
		xyz.x += 9.7470e-14 * sqrt( 2.0 * PI * 4.5282e+09 ) * cos( 2.2399e+06 * phase + shift[ 0 ] ) * exp( - 4.5282e+09 * pow2( phase ) );
		xyz /= 1.0685e-7;
		vec3 rgb = XYZ_TO_REC709 * xyz;
		return rgb;
	}
	vec3 evalIridescence( float outsideIOR, float eta2, float cosTheta1, float thinFilmThickness, vec3 baseF0 ) {
		vec3 I;
		float iridescenceIOR = mix( outsideIOR, eta2, smoothstep( 0.0, 0.03, thinFilmThickness ) );
		float sinTheta2Sq = pow2( outsideIOR / iridescenceIOR ) * ( 1.0 - pow2( cosTheta1 ) );
		float cosTheta2Sq = 1.0 - sinTheta2Sq;
		if ( cosTheta2Sq < 0.0 ) {
			return vec3( 1.0 );
		}
		float cosTheta2 = sqrt( cosTheta2Sq );
		float R0 = IorToFresnel0( iridescenceIOR, outsideIOR );
		float R12 = F_Schlick( R0, 1.0, cosTheta1 );
		float T121 = 1.0 - R12;
		float phi12 = 0.0;
		if ( iridescenceIOR < outsideIOR ) phi12 = PI;
		float phi21 = PI - phi12;
		vec3 baseIOR = Fresnel0ToIor( clamp( baseF0, 0.0, 0.9999 ) );		vec3 R1 = IorToFresnel0( baseIOR, iridescenceIOR );
		vec3 R23 = F_Schlick( R1, 1.0, cosTheta2 );
		vec3 phi23 = vec3( 0.0 );
		if ( baseIOR[ 0 ] < iridescenceIOR ) phi23[ 0 ] = PI;
		if ( baseIOR[ 1 ] < iridescenceIOR ) phi23[ 1 ] = PI;
		if ( baseIOR[ 2 ] < iridescenceIOR ) phi23[ 2 ] = PI;
		float OPD = 2.0 * iridescenceIOR * thinFilmThickness * cosTheta2;
		vec3 phi = vec3( phi21 ) + phi23;
		vec3 R123 = clamp( R12 * R23, 1e-5, 0.9999 );
		vec3 r123 = sqrt( R123 );
		vec3 Rs = pow2( T121 ) * R23 / ( vec3( 1.0 ) - R123 );
		vec3 C0 = R12 + Rs;
		I = C0;
		vec3 Cm = Rs - T121;
		for ( int m = 1; m <= 2; ++ m ) {
			Cm *= r123;
			vec3 Sm = 2.0 * evalSensitivity( float( m ) * OPD, float( m ) * phi );
			I += Cm * Sm;
		}
		return max( I, vec3( 0.0 ) );
	}
#endif`,Jx=`#ifdef USE_BUMPMAP
	uniform sampler2D bumpMap;
	uniform float bumpScale;
	vec2 dHdxy_fwd() {
		vec2 dSTdx = dFdx( vBumpMapUv );
		vec2 dSTdy = dFdy( vBumpMapUv );
		float Hll = bumpScale * texture2D( bumpMap, vBumpMapUv ).x;
		float dBx = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdx ).x - Hll;
		float dBy = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdy ).x - Hll;
		return vec2( dBx, dBy );
	}
	vec3 perturbNormalArb( vec3 surf_pos, vec3 surf_norm, vec2 dHdxy, float faceDirection ) {
		vec3 vSigmaX = normalize( dFdx( surf_pos.xyz ) );
		vec3 vSigmaY = normalize( dFdy( surf_pos.xyz ) );
		vec3 vN = surf_norm;
		vec3 R1 = cross( vSigmaY, vN );
		vec3 R2 = cross( vN, vSigmaX );
		float fDet = dot( vSigmaX, R1 ) * faceDirection;
		vec3 vGrad = sign( fDet ) * ( dHdxy.x * R1 + dHdxy.y * R2 );
		return normalize( abs( fDet ) * surf_norm - vGrad );
	}
#endif`,Qx=`#if NUM_CLIPPING_PLANES > 0
	vec4 plane;
	#ifdef ALPHA_TO_COVERAGE
		float distanceToPlane, distanceGradient;
		float clipOpacity = 1.0;
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
			distanceGradient = fwidth( distanceToPlane ) / 2.0;
			clipOpacity *= smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			if ( clipOpacity == 0.0 ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			float unionClipOpacity = 1.0;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
				distanceGradient = fwidth( distanceToPlane ) / 2.0;
				unionClipOpacity *= 1.0 - smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			}
			#pragma unroll_loop_end
			clipOpacity *= 1.0 - unionClipOpacity;
		#endif
		diffuseColor.a *= clipOpacity;
		if ( diffuseColor.a == 0.0 ) discard;
	#else
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			if ( dot( vClipPosition, plane.xyz ) > plane.w ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			bool clipped = true;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				clipped = ( dot( vClipPosition, plane.xyz ) > plane.w ) && clipped;
			}
			#pragma unroll_loop_end
			if ( clipped ) discard;
		#endif
	#endif
#endif`,jx=`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
	uniform vec4 clippingPlanes[ NUM_CLIPPING_PLANES ];
#endif`,tv=`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
#endif`,ev=`#if NUM_CLIPPING_PLANES > 0
	vClipPosition = - mvPosition.xyz;
#endif`,nv=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	diffuseColor *= vColor;
#endif`,iv=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	varying vec4 vColor;
#endif`,sv=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	varying vec4 vColor;
#endif`,rv=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	vColor = vec4( 1.0 );
#endif
#ifdef USE_COLOR_ALPHA
	vColor *= color;
#elif defined( USE_COLOR )
	vColor.rgb *= color;
#endif
#ifdef USE_INSTANCING_COLOR
	vColor.rgb *= instanceColor.rgb;
#endif
#ifdef USE_BATCHING_COLOR
	vColor *= getBatchingColor( getIndirectIndex( gl_DrawID ) );
#endif`,av=`#define PI 3.141592653589793
#define PI2 6.283185307179586
#define PI_HALF 1.5707963267948966
#define RECIPROCAL_PI 0.3183098861837907
#define RECIPROCAL_PI2 0.15915494309189535
#define EPSILON 1e-6
#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
#define whiteComplement( a ) ( 1.0 - saturate( a ) )
float pow2( const in float x ) { return x*x; }
vec3 pow2( const in vec3 x ) { return x*x; }
float pow3( const in float x ) { return x*x*x; }
float pow4( const in float x ) { float x2 = x*x; return x2*x2; }
float max3( const in vec3 v ) { return max( max( v.x, v.y ), v.z ); }
float average( const in vec3 v ) { return dot( v, vec3( 0.3333333 ) ); }
highp float rand( const in vec2 uv ) {
	const highp float a = 12.9898, b = 78.233, c = 43758.5453;
	highp float dt = dot( uv.xy, vec2( a,b ) ), sn = mod( dt, PI );
	return fract( sin( sn ) * c );
}
#ifdef HIGH_PRECISION
	float precisionSafeLength( vec3 v ) { return length( v ); }
#else
	float precisionSafeLength( vec3 v ) {
		float maxComponent = max3( abs( v ) );
		return length( v / maxComponent ) * maxComponent;
	}
#endif
struct IncidentLight {
	vec3 color;
	vec3 direction;
	bool visible;
};
struct ReflectedLight {
	vec3 directDiffuse;
	vec3 directSpecular;
	vec3 indirectDiffuse;
	vec3 indirectSpecular;
};
#ifdef USE_ALPHAHASH
	varying vec3 vPosition;
#endif
vec3 transformDirection( in vec3 dir, in mat4 matrix ) {
	return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );
}
#define inverseTransformDirection transformDirectionByInverseViewMatrix
vec3 transformNormalByInverseViewMatrix( in vec3 normal, in mat4 viewMatrix ) {
	return normalize( ( vec4( normal, 0.0 ) * viewMatrix ).xyz );
}
vec3 transformDirectionByInverseViewMatrix( in vec3 dir, in mat4 viewMatrix ) {
	return normalize( ( vec4( dir, 0.0 ) * viewMatrix ).xyz );
}
bool isPerspectiveMatrix( mat4 m ) {
	return m[ 2 ][ 3 ] == - 1.0;
}
vec2 equirectUv( in vec3 dir ) {
	float u = atan( dir.z, dir.x ) * RECIPROCAL_PI2 + 0.5;
	float v = asin( clamp( dir.y, - 1.0, 1.0 ) ) * RECIPROCAL_PI + 0.5;
	return vec2( u, v );
}
vec3 BRDF_Lambert( const in vec3 diffuseColor ) {
	return RECIPROCAL_PI * diffuseColor;
}
vec3 F_Schlick( const in vec3 f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
}
float F_Schlick( const in float f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
} // validated`,ov=`vec3 transformedNormal = objectNormal;
#ifdef USE_TANGENT
	vec3 transformedTangent = objectTangent;
#endif
#ifdef USE_BATCHING
	mat3 bm = mat3( batchingMatrix );
	transformedNormal /= vec3( dot( bm[ 0 ], bm[ 0 ] ), dot( bm[ 1 ], bm[ 1 ] ), dot( bm[ 2 ], bm[ 2 ] ) );
	transformedNormal = bm * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = bm * transformedTangent;
	#endif
#endif
#ifdef USE_INSTANCING
	mat3 im = mat3( instanceMatrix );
	transformedNormal /= vec3( dot( im[ 0 ], im[ 0 ] ), dot( im[ 1 ], im[ 1 ] ), dot( im[ 2 ], im[ 2 ] ) );
	transformedNormal = im * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = im * transformedTangent;
	#endif
#endif
transformedNormal = normalMatrix * transformedNormal;
#ifdef FLIP_SIDED
	transformedNormal = - transformedNormal;
#endif
#ifdef USE_TANGENT
	transformedTangent = ( modelViewMatrix * vec4( transformedTangent, 0.0 ) ).xyz;
#endif`,lv=`#ifdef USE_DISPLACEMENTMAP
	uniform sampler2D displacementMap;
	uniform float displacementScale;
	uniform float displacementBias;
#endif`,cv=`#ifdef USE_DISPLACEMENTMAP
	transformed += normalize( objectNormal ) * ( texture2D( displacementMap, vDisplacementMapUv ).x * displacementScale + displacementBias );
#endif`,hv=`#ifdef USE_EMISSIVEMAP
	vec4 emissiveColor = texture2D( emissiveMap, vEmissiveMapUv );
	#ifdef DECODE_VIDEO_TEXTURE_EMISSIVE
		emissiveColor = sRGBTransferEOTF( emissiveColor );
	#endif
	totalEmissiveRadiance *= emissiveColor.rgb;
#endif`,uv=`#ifdef USE_EMISSIVEMAP
	uniform sampler2D emissiveMap;
#endif`,fv="gl_FragColor = linearToOutputTexel( gl_FragColor );",dv=`vec4 LinearTransferOETF( in vec4 value ) {
	return value;
}
vec4 sRGBTransferEOTF( in vec4 value ) {
	return vec4( mix( pow( value.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), value.rgb * 0.0773993808, vec3( lessThanEqual( value.rgb, vec3( 0.04045 ) ) ) ), value.a );
}
vec4 sRGBTransferOETF( in vec4 value ) {
	return vec4( mix( pow( value.rgb, vec3( 0.41666 ) ) * 1.055 - vec3( 0.055 ), value.rgb * 12.92, vec3( lessThanEqual( value.rgb, vec3( 0.0031308 ) ) ) ), value.a );
}`,pv=`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vec3 cameraToFrag;
		if ( isOrthographic ) {
			cameraToFrag = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToFrag = normalize( vWorldPosition - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vec3 reflectVec = reflect( cameraToFrag, worldNormal );
		#else
			vec3 reflectVec = refract( cameraToFrag, worldNormal, refractionRatio );
		#endif
	#else
		vec3 reflectVec = vReflect;
	#endif
	#ifdef ENVMAP_TYPE_CUBE
		vec4 envColor = textureCube( envMap, envMapRotation * reflectVec );
		#ifdef ENVMAP_BLENDING_MULTIPLY
			outgoingLight = mix( outgoingLight, outgoingLight * envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_MIX )
			outgoingLight = mix( outgoingLight, envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_ADD )
			outgoingLight += envColor.xyz * specularStrength * reflectivity;
		#endif
	#endif
#endif`,mv=`#ifdef USE_ENVMAP
	uniform float envMapIntensity;
	uniform mat3 envMapRotation;
	uniform samplerCube envMap;
	#ifdef ENVMAP_TYPE_PMREM
		float roughnessToMip( const in float roughness ) {
			float r = clamp( roughness, 0.0, 1.0 );
			return ENVMAP_MAX_LOD * r * ( 2.0 - r );
		}
	#endif
#endif`,gv=`#ifdef USE_ENVMAP
	uniform float reflectivity;
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		varying vec3 vWorldPosition;
		uniform float refractionRatio;
	#else
		varying vec3 vReflect;
	#endif
#endif`,_v=`#ifdef USE_ENVMAP
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		
		varying vec3 vWorldPosition;
	#else
		varying vec3 vReflect;
		uniform float refractionRatio;
	#endif
#endif`,xv=`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vWorldPosition = worldPosition.xyz;
	#else
		vec3 cameraToVertex;
		if ( isOrthographic ) {
			cameraToVertex = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToVertex = normalize( worldPosition.xyz - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vReflect = reflect( cameraToVertex, worldNormal );
		#else
			vReflect = refract( cameraToVertex, worldNormal, refractionRatio );
		#endif
	#endif
#endif`,vv=`#ifdef USE_FOG
	vFogDepth = - mvPosition.z;
#endif`,Mv=`#ifdef USE_FOG
	varying float vFogDepth;
#endif`,Sv=`#ifdef USE_FOG
	#ifdef FOG_EXP2
		float fogFactor = 1.0 - exp( - fogDensity * fogDensity * vFogDepth * vFogDepth );
	#else
		float fogFactor = smoothstep( fogNear, fogFar, vFogDepth );
	#endif
	gl_FragColor.rgb = mix( gl_FragColor.rgb, fogColor, fogFactor );
#endif`,yv=`#ifdef USE_FOG
	uniform vec3 fogColor;
	varying float vFogDepth;
	#ifdef FOG_EXP2
		uniform float fogDensity;
	#else
		uniform float fogNear;
		uniform float fogFar;
	#endif
#endif`,Ev=`#ifdef USE_GRADIENTMAP
	uniform sampler2D gradientMap;
#endif
vec3 getGradientIrradiance( vec3 normal, vec3 lightDirection ) {
	float dotNL = dot( normal, lightDirection );
	vec2 coord = vec2( dotNL * 0.5 + 0.5, 0.0 );
	#ifdef USE_GRADIENTMAP
		return vec3( texture2D( gradientMap, coord ).r );
	#else
		vec2 fw = fwidth( coord ) * 0.5;
		return mix( vec3( 0.7 ), vec3( 1.0 ), smoothstep( 0.7 - fw.x, 0.7 + fw.x, coord.x ) );
	#endif
}`,bv=`#ifdef USE_LIGHTMAP
	uniform sampler2D lightMap;
	uniform float lightMapIntensity;
#endif`,wv=`LambertMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularStrength = specularStrength;`,Tv=`varying vec3 vViewPosition;
struct LambertMaterial {
	vec3 diffuseColor;
	float specularStrength;
};
void RE_Direct_Lambert( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Lambert( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Lambert
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Lambert`,Av=`uniform bool receiveShadow;
uniform vec3 ambientLightColor;
#if defined( USE_LIGHT_PROBES )
	uniform vec3 lightProbe[ 9 ];
#endif
vec3 shGetIrradianceAt( in vec3 normal, in vec3 shCoefficients[ 9 ] ) {
	float x = normal.x, y = normal.y, z = normal.z;
	vec3 result = shCoefficients[ 0 ] * 0.886227;
	result += shCoefficients[ 1 ] * 2.0 * 0.511664 * y;
	result += shCoefficients[ 2 ] * 2.0 * 0.511664 * z;
	result += shCoefficients[ 3 ] * 2.0 * 0.511664 * x;
	result += shCoefficients[ 4 ] * 2.0 * 0.429043 * x * y;
	result += shCoefficients[ 5 ] * 2.0 * 0.429043 * y * z;
	result += shCoefficients[ 6 ] * ( 0.743125 * z * z - 0.247708 );
	result += shCoefficients[ 7 ] * 2.0 * 0.429043 * x * z;
	result += shCoefficients[ 8 ] * 0.429043 * ( x * x - y * y );
	return result;
}
vec3 getLightProbeIrradiance( const in vec3 lightProbe[ 9 ], const in vec3 normal ) {
	vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec3 irradiance = shGetIrradianceAt( worldNormal, lightProbe );
	return irradiance;
}
vec3 getAmbientLightIrradiance( const in vec3 ambientLightColor ) {
	vec3 irradiance = ambientLightColor;
	return irradiance;
}
float getDistanceAttenuation( const in float lightDistance, const in float cutoffDistance, const in float decayExponent ) {
	float distanceFalloff = 1.0 / max( pow( lightDistance, decayExponent ), 0.01 );
	if ( cutoffDistance > 0.0 ) {
		distanceFalloff *= pow2( saturate( 1.0 - pow4( lightDistance / cutoffDistance ) ) );
	}
	return distanceFalloff;
}
float getSpotAttenuation( const in float coneCosine, const in float penumbraCosine, const in float angleCosine ) {
	return smoothstep( coneCosine, penumbraCosine, angleCosine );
}
#if NUM_SUN_LIGHTS > 0
	struct SunLight {
		vec3 direction;
		vec3 color;
	};
	uniform SunLight sunLights[ NUM_SUN_LIGHTS ];
	void getSunLightInfo( const in SunLight sunLight, out IncidentLight light ) {
		light.color = sunLight.color;
		light.direction = sunLight.direction;
		light.visible = true;
	}
#endif
#if NUM_DIR_LIGHTS > 0
	struct DirectionalLight {
		vec3 direction;
		vec3 color;
	};
	uniform DirectionalLight directionalLights[ NUM_DIR_LIGHTS ];
	void getDirectionalLightInfo( const in DirectionalLight directionalLight, out IncidentLight light ) {
		light.color = directionalLight.color;
		light.direction = directionalLight.direction;
		light.visible = true;
	}
#endif
#if NUM_POINT_LIGHTS > 0
	struct PointLight {
		vec3 position;
		vec3 color;
		float distance;
		float decay;
	};
	uniform PointLight pointLights[ NUM_POINT_LIGHTS ];
	void getPointLightInfo( const in PointLight pointLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = pointLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float lightDistance = length( lVector );
		light.color = pointLight.color;
		light.color *= getDistanceAttenuation( lightDistance, pointLight.distance, pointLight.decay );
		light.visible = ( light.color != vec3( 0.0 ) );
	}
#endif
#if NUM_SPOT_LIGHTS > 0
	struct SpotLight {
		vec3 position;
		vec3 direction;
		vec3 color;
		float distance;
		float decay;
		float coneCos;
		float penumbraCos;
	};
	uniform SpotLight spotLights[ NUM_SPOT_LIGHTS ];
	void getSpotLightInfo( const in SpotLight spotLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = spotLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float angleCos = dot( light.direction, spotLight.direction );
		float spotAttenuation = getSpotAttenuation( spotLight.coneCos, spotLight.penumbraCos, angleCos );
		if ( spotAttenuation > 0.0 ) {
			float lightDistance = length( lVector );
			light.color = spotLight.color * spotAttenuation;
			light.color *= getDistanceAttenuation( lightDistance, spotLight.distance, spotLight.decay );
			light.visible = ( light.color != vec3( 0.0 ) );
		} else {
			light.color = vec3( 0.0 );
			light.visible = false;
		}
	}
#endif
#if NUM_RECT_AREA_LIGHTS > 0
	struct RectAreaLight {
		vec3 color;
		vec3 position;
		vec3 halfWidth;
		vec3 halfHeight;
	};
	uniform sampler2D ltc_1;	uniform sampler2D ltc_2;
	uniform RectAreaLight rectAreaLights[ NUM_RECT_AREA_LIGHTS ];
#endif
#if NUM_HEMI_LIGHTS > 0
	struct HemisphereLight {
		vec3 direction;
		vec3 skyColor;
		vec3 groundColor;
	};
	uniform HemisphereLight hemisphereLights[ NUM_HEMI_LIGHTS ];
	vec3 getHemisphereLightIrradiance( const in HemisphereLight hemiLight, const in vec3 normal ) {
		float dotNL = dot( normal, hemiLight.direction );
		float hemiDiffuseWeight = 0.5 * dotNL + 0.5;
		vec3 irradiance = mix( hemiLight.groundColor, hemiLight.skyColor, hemiDiffuseWeight );
		return irradiance;
	}
#endif
#include <lightprobes_pars_fragment>`,Rv=`#ifdef USE_ENVMAP
	vec3 getIBLIrradiance( const in vec3 normal ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * worldNormal, ENVMAP_MAX_LOD );
			return PI * envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	vec3 getIBLRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 reflectVec = reflect( - viewDir, normal );
			reflectVec = normalize( mix( reflectVec, normal, pow4( roughness ) ) );
			reflectVec = transformDirectionByInverseViewMatrix( reflectVec, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * reflectVec, roughnessToMip( roughness ) );
			return envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	#ifdef USE_RETROREFLECTION
		vec3 getIBLRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 retroVec = normalize( mix( viewDir, normal, pow4( roughness ) ) );
				retroVec = transformDirectionByInverseViewMatrix( retroVec, viewMatrix );
				vec4 envMapColor = textureLod( envMap, envMapRotation * retroVec, roughnessToMip( roughness ) );
				return envMapColor.rgb * envMapIntensity;
			#else
				return vec3( 0.0 );
			#endif
		}
	#endif
	#ifdef USE_ANISOTROPY
		vec3 getIBLAnisotropyRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 bentNormal = cross( bitangent, viewDir );
				bentNormal = normalize( cross( bentNormal, bitangent ) );
				bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
				return getIBLRadiance( viewDir, bentNormal, roughness );
			#else
				return vec3( 0.0 );
			#endif
		}
		#ifdef USE_RETROREFLECTION
			vec3 getIBLAnisotropyRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
				#ifdef ENVMAP_TYPE_PMREM
					vec3 bentNormal = cross( bitangent, viewDir );
					bentNormal = normalize( cross( bentNormal, bitangent ) );
					bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
					return getIBLRetroRadiance( viewDir, bentNormal, roughness );
				#else
					return vec3( 0.0 );
				#endif
			}
		#endif
	#endif
#endif`,Cv=`ToonMaterial material;
material.diffuseColor = diffuseColor.rgb;`,Pv=`varying vec3 vViewPosition;
struct ToonMaterial {
	vec3 diffuseColor;
};
void RE_Direct_Toon( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 irradiance = getGradientIrradiance( geometryNormal, directLight.direction ) * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Toon( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Toon
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Toon`,Lv=`BlinnPhongMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularColor = specular;
material.specularShininess = shininess;
material.specularStrength = specularStrength;`,Dv=`varying vec3 vViewPosition;
struct BlinnPhongMaterial {
	vec3 diffuseColor;
	vec3 specularColor;
	float specularShininess;
	float specularStrength;
};
void RE_Direct_BlinnPhong( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
	reflectedLight.directSpecular += irradiance * BRDF_BlinnPhong( directLight.direction, geometryViewDir, geometryNormal, material.specularColor, material.specularShininess ) * material.specularStrength;
}
void RE_IndirectDiffuse_BlinnPhong( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_BlinnPhong
#define RE_IndirectDiffuse		RE_IndirectDiffuse_BlinnPhong`,Nv=`PhysicalMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.diffuseContribution = diffuseColor.rgb * ( 1.0 - metalnessFactor );
material.metalness = metalnessFactor;
vec3 dxy = max( abs( dFdx( nonPerturbedNormal ) ), abs( dFdy( nonPerturbedNormal ) ) );
float geometryRoughness = max( max( dxy.x, dxy.y ), dxy.z );
material.roughness = max( roughnessFactor, 0.045 );
material.roughness += geometryRoughness;
material.roughness = min( material.roughness, 1.0 );
#ifdef USE_DIFFUSE_ROUGHNESS
	float diffuseRoughnessFactor = diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		diffuseRoughnessFactor *= texture2D( diffuseRoughnessMap, vDiffuseRoughnessMapUv ).r;
	#endif
	material.diffuseRoughness = saturate( diffuseRoughnessFactor );
#endif
#ifdef IOR
	material.ior = ior;
	#ifdef USE_SPECULAR
		float specularIntensityFactor = specularIntensity;
		vec3 specularColorFactor = specularColor;
		#ifdef USE_SPECULAR_COLORMAP
			specularColorFactor *= texture2D( specularColorMap, vSpecularColorMapUv ).rgb;
		#endif
		#ifdef USE_SPECULAR_INTENSITYMAP
			specularIntensityFactor *= texture2D( specularIntensityMap, vSpecularIntensityMapUv ).a;
		#endif
		material.specularF90 = mix( specularIntensityFactor, 1.0, metalnessFactor );
	#else
		float specularIntensityFactor = 1.0;
		vec3 specularColorFactor = vec3( 1.0 );
		material.specularF90 = 1.0;
	#endif
	material.specularColor = min( pow2( ( material.ior - 1.0 ) / ( material.ior + 1.0 ) ) * specularColorFactor, vec3( 1.0 ) ) * specularIntensityFactor;
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
#else
	material.specularColor = vec3( 0.04 );
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
	material.specularF90 = 1.0;
#endif
#ifdef USE_CLEARCOAT
	material.clearcoat = clearcoat;
	material.clearcoatRoughness = clearcoatRoughness;
	material.clearcoatF0 = vec3( 0.04 );
	material.clearcoatF90 = 1.0;
	#ifdef USE_CLEARCOATMAP
		material.clearcoat *= texture2D( clearcoatMap, vClearcoatMapUv ).x;
	#endif
	#ifdef USE_CLEARCOAT_ROUGHNESSMAP
		material.clearcoatRoughness *= texture2D( clearcoatRoughnessMap, vClearcoatRoughnessMapUv ).y;
	#endif
	material.clearcoat = saturate( material.clearcoat );	material.clearcoatRoughness = max( material.clearcoatRoughness, 0.045 );
	material.clearcoatRoughness += geometryRoughness;
	material.clearcoatRoughness = min( material.clearcoatRoughness, 1.0 );
#endif
#ifdef USE_DISPERSION
	material.dispersion = dispersion;
#endif
#ifdef USE_RETROREFLECTION
	material.retroreflectivity = retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	material.iridescence = iridescence;
	material.iridescenceIOR = iridescenceIOR;
	#ifdef USE_IRIDESCENCEMAP
		material.iridescence *= texture2D( iridescenceMap, vIridescenceMapUv ).r;
	#endif
	#ifdef USE_IRIDESCENCE_THICKNESSMAP
		material.iridescenceThickness = (iridescenceThicknessMaximum - iridescenceThicknessMinimum) * texture2D( iridescenceThicknessMap, vIridescenceThicknessMapUv ).g + iridescenceThicknessMinimum;
	#else
		material.iridescenceThickness = iridescenceThicknessMaximum;
	#endif
#endif
#ifdef USE_SHEEN
	material.sheenColor = sheenColor;
	#ifdef USE_SHEEN_COLORMAP
		material.sheenColor *= texture2D( sheenColorMap, vSheenColorMapUv ).rgb;
	#endif
	material.sheenRoughness = clamp( sheenRoughness, 0.0001, 1.0 );
	#ifdef USE_SHEEN_ROUGHNESSMAP
		material.sheenRoughness *= texture2D( sheenRoughnessMap, vSheenRoughnessMapUv ).a;
	#endif
#endif
#ifdef USE_ANISOTROPY
	#ifdef USE_ANISOTROPYMAP
		mat2 anisotropyMat = mat2( anisotropyVector.x, anisotropyVector.y, - anisotropyVector.y, anisotropyVector.x );
		vec3 anisotropyPolar = texture2D( anisotropyMap, vAnisotropyMapUv ).rgb;
		vec2 anisotropyV = anisotropyMat * normalize( 2.0 * anisotropyPolar.rg - vec2( 1.0 ) ) * anisotropyPolar.b;
	#else
		vec2 anisotropyV = anisotropyVector;
	#endif
	material.anisotropy = length( anisotropyV );
	if( material.anisotropy == 0.0 ) {
		anisotropyV = vec2( 1.0, 0.0 );
	} else {
		anisotropyV /= material.anisotropy;
		material.anisotropy = saturate( material.anisotropy );
	}
	material.alphaT = mix( pow2( material.roughness ), 1.0, pow2( material.anisotropy ) );
	material.anisotropyT = tbn[ 0 ] * anisotropyV.x + tbn[ 1 ] * anisotropyV.y;
	material.anisotropyB = tbn[ 1 ] * anisotropyV.x - tbn[ 0 ] * anisotropyV.y;
#endif`,Iv=`uniform sampler2D dfgLUT;
struct PhysicalMaterial {
	vec3 diffuseColor;
	vec3 diffuseContribution;
	vec3 specularColor;
	vec3 specularColorBlended;
	float roughness;
	float metalness;
	float specularF90;
	float dispersion;
	vec2 dfg;
	vec3 multiScatteringCompensation;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float diffuseRoughness;
	#endif
	#ifdef USE_RETROREFLECTION
		float retroreflectivity;
	#endif
	#ifdef USE_CLEARCOAT
		float clearcoat;
		float clearcoatRoughness;
		vec3 clearcoatF0;
		float clearcoatF90;
	#endif
	#ifdef USE_IRIDESCENCE
		float iridescence;
		float iridescenceIOR;
		float iridescenceThickness;
		vec3 iridescenceFresnel;
		vec3 iridescenceF0Dielectric;
		vec3 iridescenceF0Metallic;
	#endif
	#ifdef USE_SHEEN
		vec3 sheenColor;
		float sheenRoughness;
	#endif
	#ifdef IOR
		float ior;
	#endif
	#ifdef USE_TRANSMISSION
		float transmission;
		float transmissionAlpha;
		float thickness;
		float attenuationDistance;
		vec3 attenuationColor;
	#endif
	#ifdef USE_ANISOTROPY
		float anisotropy;
		float alphaT;
		vec3 anisotropyT;
		vec3 anisotropyB;
	#endif
};
vec3 clearcoatSpecularDirect = vec3( 0.0 );
vec3 clearcoatSpecularIndirect = vec3( 0.0 );
vec3 sheenSpecularDirect = vec3( 0.0 );
vec3 sheenSpecularIndirect = vec3(0.0 );
vec3 Schlick_to_F0( const in vec3 f, const in float f90, const in float dotVH ) {
    float x = clamp( 1.0 - dotVH, 0.0, 1.0 );
    float x2 = x * x;
    float x5 = clamp( x * x2 * x2, 0.0, 0.9999 );
    return ( f - vec3( f90 ) * x5 ) / ( 1.0 - x5 );
}
#ifdef USE_DIFFUSE_ROUGHNESS
	const float EON_EPSILON = 1e-7;
	float FON_DirectionalAlbedo( const in float mu, const in float roughness, const in float A ) {
		float muComp = 1.0 - mu;
		float gOverPi = muComp * ( 0.0571085289 + muComp * ( 0.491881867 + muComp * ( - 0.332181442 + muComp * 0.0714429953 ) ) );
		return A * ( 1.0 + roughness * gOverPi );
	}
	vec3 BRDF_EON( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 diffuseColor, const in float roughness ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return BRDF_Lambert( rho );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float s = dot( lightDir, viewDir ) - dotNL * dotNV;
		float sOverT = ( s > 0.0 ) ? s / max( max( dotNL, dotNV ), EON_EPSILON ) : s;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		vec3 singleScatter = rho * RECIPROCAL_PI * A * ( 1.0 + roughness * sOverT );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		float albedoV = FON_DirectionalAlbedo( dotNV, roughness, A );
		float albedoL = FON_DirectionalAlbedo( dotNL, roughness, A );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		vec3 multiScatter = rhoMultiScatter * RECIPROCAL_PI
			* max( EON_EPSILON, 1.0 - albedoV )
			* max( EON_EPSILON, 1.0 - albedoL )
			/ max( EON_EPSILON, 1.0 - averageAlbedo );
		return singleScatter + multiScatter;
	}
	vec3 EON_DirectionalAlbedo( const in vec3 diffuseColor, const in float roughness, const in float dotNV ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return rho;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		float directionalAlbedo = FON_DirectionalAlbedo( dotNV, roughness, A );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		return rho * directionalAlbedo + rhoMultiScatter * ( 1.0 - directionalAlbedo );
	}
#endif
float V_GGX_SmithCorrelated( const in float alpha, const in float dotNL, const in float dotNV ) {
	float a2 = pow2( alpha );
	float gv = dotNL * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNV ) );
	float gl = dotNV * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNL ) );
	return 0.5 / max( gv + gl, EPSILON );
}
float D_GGX( const in float alpha, const in float dotNH ) {
	float a2 = pow2( alpha );
	float denom = pow2( dotNH ) * ( a2 - 1.0 ) + 1.0;
	return RECIPROCAL_PI * a2 / pow2( denom );
}
#ifdef USE_ANISOTROPY
	float V_GGX_SmithCorrelated_Anisotropic( const in float alphaT, const in float alphaB, const in float dotTV, const in float dotBV, const in float dotTL, const in float dotBL, const in float dotNV, const in float dotNL ) {
		float gv = dotNL * length( vec3( alphaT * dotTV, alphaB * dotBV, dotNV ) );
		float gl = dotNV * length( vec3( alphaT * dotTL, alphaB * dotBL, dotNL ) );
		return 0.5 / max( gv + gl, EPSILON );
	}
	float D_GGX_Anisotropic( const in float alphaT, const in float alphaB, const in float dotNH, const in float dotTH, const in float dotBH ) {
		float a2 = alphaT * alphaB;
		highp vec3 v = vec3( alphaB * dotTH, alphaT * dotBH, a2 * dotNH );
		highp float v2 = dot( v, v );
		float w2 = a2 / v2;
		return RECIPROCAL_PI * a2 * pow2 ( w2 );
	}
#endif
#ifdef USE_CLEARCOAT
	vec3 BRDF_GGX_Clearcoat( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material) {
		vec3 f0 = material.clearcoatF0;
		float f90 = material.clearcoatF90;
		float roughness = max( material.clearcoatRoughness, 0.045 );
		float alpha = pow2( roughness );
		vec3 halfDir = normalize( lightDir + viewDir );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float dotNH = saturate( dot( normal, halfDir ) );
		float dotVH = saturate( dot( viewDir, halfDir ) );
		vec3 F = F_Schlick( f0, f90, dotVH );
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
		return F * ( V * D );
	}
#endif
vec3 BRDF_GGX( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material ) {
	vec3 f0 = material.specularColorBlended;
	float f90 = material.specularF90;
	float roughness = max( material.roughness, 0.045 );
	float alpha = pow2( roughness );
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( f0, f90, dotVH );
	#ifdef USE_IRIDESCENCE
		F = mix( F, material.iridescenceFresnel, material.iridescence );
	#endif
	#ifdef USE_ANISOTROPY
		float dotTL = dot( material.anisotropyT, lightDir );
		float dotTV = dot( material.anisotropyT, viewDir );
		float dotTH = dot( material.anisotropyT, halfDir );
		float dotBL = dot( material.anisotropyB, lightDir );
		float dotBV = dot( material.anisotropyB, viewDir );
		float dotBH = dot( material.anisotropyB, halfDir );
		float alphaT = max( material.alphaT, alpha );
		float V = V_GGX_SmithCorrelated_Anisotropic( alphaT, alpha, dotTV, dotBV, dotTL, dotBL, dotNV, dotNL );
		float D = D_GGX_Anisotropic( alphaT, alpha, dotNH, dotTH, dotBH );
	#else
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
	#endif
	return F * ( V * D );
}
vec2 LTC_Uv( const in vec3 N, const in vec3 V, const in float roughness ) {
	const float LUT_SIZE = 64.0;
	const float LUT_SCALE = ( LUT_SIZE - 1.0 ) / LUT_SIZE;
	const float LUT_BIAS = 0.5 / LUT_SIZE;
	float dotNV = saturate( dot( N, V ) );
	vec2 uv = vec2( roughness, sqrt( 1.0 - dotNV ) );
	uv = uv * LUT_SCALE + LUT_BIAS;
	return uv;
}
float LTC_ClippedSphereFormFactor( const in vec3 f ) {
	float l = length( f );
	return max( ( l * l + f.z ) / ( l + 1.0 ), 0.0 );
}
vec3 LTC_EdgeVectorFormFactor( const in vec3 v1, const in vec3 v2 ) {
	float x = dot( v1, v2 );
	float y = abs( x );
	float a = 0.8543985 + ( 0.4965155 + 0.0145206 * y ) * y;
	float b = 3.4175940 + ( 4.1616724 + y ) * y;
	float v = a / b;
	float theta_sintheta = ( x > 0.0 ) ? v : 0.5 * inversesqrt( max( 1.0 - x * x, 1e-7 ) ) - v;
	return cross( v1, v2 ) * theta_sintheta;
}
vec3 LTC_Evaluate( const in vec3 N, const in vec3 V, const in vec3 P, const in mat3 mInv, const in vec3 rectCoords[ 4 ] ) {
	vec3 v1 = rectCoords[ 1 ] - rectCoords[ 0 ];
	vec3 v2 = rectCoords[ 3 ] - rectCoords[ 0 ];
	vec3 lightNormal = cross( v1, v2 );
	if( dot( lightNormal, P - rectCoords[ 0 ] ) < 0.0 ) return vec3( 0.0 );
	vec3 T1, T2;
	T1 = normalize( V - N * dot( V, N ) );
	T2 = - cross( N, T1 );
	mat3 mat = mInv * transpose( mat3( T1, T2, N ) );
	vec3 coords[ 4 ];
	coords[ 0 ] = mat * ( rectCoords[ 0 ] - P );
	coords[ 1 ] = mat * ( rectCoords[ 1 ] - P );
	coords[ 2 ] = mat * ( rectCoords[ 2 ] - P );
	coords[ 3 ] = mat * ( rectCoords[ 3 ] - P );
	coords[ 0 ] = normalize( coords[ 0 ] );
	coords[ 1 ] = normalize( coords[ 1 ] );
	coords[ 2 ] = normalize( coords[ 2 ] );
	coords[ 3 ] = normalize( coords[ 3 ] );
	vec3 vectorFormFactor = vec3( 0.0 );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 0 ], coords[ 1 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 1 ], coords[ 2 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 2 ], coords[ 3 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 3 ], coords[ 0 ] );
	float result = LTC_ClippedSphereFormFactor( vectorFormFactor );
	return vec3( result );
}
#if defined( USE_SHEEN )
float D_Charlie( float roughness, float dotNH ) {
	float alpha = pow2( roughness );
	float invAlpha = 1.0 / alpha;
	float cos2h = dotNH * dotNH;
	float sin2h = max( 1.0 - cos2h, 0.0078125 );
	return ( 2.0 + invAlpha ) * pow( sin2h, invAlpha * 0.5 ) / ( 2.0 * PI );
}
float V_Neubelt( float dotNV, float dotNL ) {
	return saturate( 1.0 / ( 4.0 * ( dotNL + dotNV - dotNL * dotNV ) ) );
}
vec3 BRDF_Sheen( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, vec3 sheenColor, const in float sheenRoughness ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float D = D_Charlie( sheenRoughness, dotNH );
	float V = V_Neubelt( dotNV, dotNL );
	return sheenColor * ( D * V );
}
#endif
float IBLSheenBRDF( const in vec3 normal, const in vec3 viewDir, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	float r2 = roughness * roughness;
	float rInv = 1.0 / ( roughness + 0.1 );
	float a = -1.9362 + 1.0678 * roughness + 0.4573 * r2 - 0.8469 * rInv;
	float b = -0.6014 + 0.5538 * roughness - 0.4670 * r2 - 0.1255 * rInv;
	float DG = exp( a * dotNV + b );
	return saturate( DG );
}
vec3 EnvironmentBRDF( const in vec3 normal, const in vec3 viewDir, const in vec3 specularColor, const in float specularF90, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	vec2 fab = texture2D( dfgLUT, vec2( roughness, dotNV ) ).rg;
	return specularColor * fab.x + specularF90 * fab.y;
}
#ifdef USE_IRIDESCENCE
void computeMultiscatteringIridescence( const in vec2 fab, const in vec3 specularColor, const in float specularF90, const in float iridescence, const in vec3 iridescenceF0, inout vec3 singleScatter, inout vec3 multiScatter ) {
#else
void computeMultiscattering( const in vec2 fab, const in vec3 specularColor, const in float specularF90, inout vec3 singleScatter, inout vec3 multiScatter ) {
#endif
	#ifdef USE_IRIDESCENCE
		vec3 Fr = mix( specularColor, iridescenceF0, iridescence );
	#else
		vec3 Fr = specularColor;
	#endif
	vec3 FssEss = Fr * fab.x + specularF90 * fab.y;
	float Ess = fab.x + fab.y;
	float Ems = 1.0 - Ess;
	vec3 Favg = Fr + ( 1.0 - Fr ) * 0.047619;	vec3 Fms = FssEss * Favg / ( 1.0 - Ems * Favg );
	singleScatter += FssEss;
	multiScatter += Fms * Ems;
}
#if NUM_RECT_AREA_LIGHTS > 0
	void RE_Direct_RectArea_Physical( const in RectAreaLight rectAreaLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
		vec3 normal = geometryNormal;
		vec3 viewDir = geometryViewDir;
		vec3 position = geometryPosition;
		vec3 lightPos = rectAreaLight.position;
		vec3 halfWidth = rectAreaLight.halfWidth;
		vec3 halfHeight = rectAreaLight.halfHeight;
		vec3 lightColor = rectAreaLight.color;
		float roughness = material.roughness;
		vec3 rectCoords[ 4 ];
		rectCoords[ 0 ] = lightPos + halfWidth - halfHeight;		rectCoords[ 1 ] = lightPos - halfWidth - halfHeight;
		rectCoords[ 2 ] = lightPos - halfWidth + halfHeight;
		rectCoords[ 3 ] = lightPos + halfWidth + halfHeight;
		vec2 uv = LTC_Uv( normal, viewDir, roughness );
		vec4 t1 = texture2D( ltc_1, uv );
		vec4 t2 = texture2D( ltc_2, uv );
		mat3 mInv = mat3(
			vec3( t1.x, 0, t1.y ),
			vec3(    0, 1,    0 ),
			vec3( t1.z, 0, t1.w )
		);
		vec3 fresnel = ( material.specularColorBlended * t2.x + ( material.specularF90 - material.specularColorBlended ) * t2.y );
		reflectedLight.directSpecular += lightColor * fresnel * LTC_Evaluate( normal, viewDir, position, mInv, rectCoords );
		reflectedLight.directDiffuse += lightColor * material.diffuseContribution * LTC_Evaluate( normal, viewDir, position, mat3( 1.0 ), rectCoords );
		#ifdef USE_CLEARCOAT
			vec3 Ncc = geometryClearcoatNormal;
			vec2 uvClearcoat = LTC_Uv( Ncc, viewDir, material.clearcoatRoughness );
			vec4 t1Clearcoat = texture2D( ltc_1, uvClearcoat );
			vec4 t2Clearcoat = texture2D( ltc_2, uvClearcoat );
			mat3 mInvClearcoat = mat3(
				vec3( t1Clearcoat.x, 0, t1Clearcoat.y ),
				vec3(             0, 1,             0 ),
				vec3( t1Clearcoat.z, 0, t1Clearcoat.w )
			);
			vec3 fresnelClearcoat = material.clearcoatF0 * t2Clearcoat.x + ( material.clearcoatF90 - material.clearcoatF0 ) * t2Clearcoat.y;
			clearcoatSpecularDirect += lightColor * fresnelClearcoat * LTC_Evaluate( Ncc, viewDir, position, mInvClearcoat, rectCoords );
		#endif
	}
#endif
void RE_Direct_Physical( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	#ifdef USE_CLEARCOAT
		float dotNLcc = saturate( dot( geometryClearcoatNormal, directLight.direction ) );
		vec3 ccIrradiance = dotNLcc * directLight.color;
		clearcoatSpecularDirect += ccIrradiance * BRDF_GGX_Clearcoat( directLight.direction, geometryViewDir, geometryClearcoatNormal, material );
	#endif
	#ifdef USE_SHEEN
 
 		sheenSpecularDirect += irradiance * BRDF_Sheen( directLight.direction, geometryViewDir, geometryNormal, material.sheenColor, material.sheenRoughness );
 
 		float sheenAlbedoV = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
 		float sheenAlbedoL = IBLSheenBRDF( geometryNormal, directLight.direction, material.sheenRoughness );
 
 		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * max( sheenAlbedoV, sheenAlbedoL );
 
 		irradiance *= sheenEnergyComp;
 
 	#endif
	vec3 specularBRDF = BRDF_GGX( directLight.direction, geometryViewDir, geometryNormal, material );
	#ifdef USE_RETROREFLECTION
		vec3 retroViewDir = reflect( - geometryViewDir, geometryNormal );
		vec3 retroSpecularBRDF = BRDF_GGX( directLight.direction, retroViewDir, geometryNormal, material );
		specularBRDF = mix( specularBRDF, retroSpecularBRDF, saturate( material.retroreflectivity ) );
	#endif
	reflectedLight.directSpecular += irradiance * specularBRDF * material.multiScatteringCompensation;
	vec3 halfDir = normalize( directLight.direction + geometryViewDir );
	float dotVH = saturate( dot( geometryViewDir, halfDir ) );
	vec3 F = F_Schlick( material.specularColor, material.specularF90, dotVH );
	#ifdef USE_RETROREFLECTION
		vec3 retroHalfDir = normalize( directLight.direction + retroViewDir );
		float dotRetroVH = saturate( dot( retroViewDir, retroHalfDir ) );
		vec3 retroF = F_Schlick( material.specularColor, material.specularF90, dotRetroVH );
		F = mix( F, retroF, saturate( material.retroreflectivity ) );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		vec3 diffuseBRDF = BRDF_EON( directLight.direction, geometryViewDir, geometryNormal, material.diffuseColor, material.diffuseRoughness ) * ( 1.0 - material.metalness );
	#else
		vec3 diffuseBRDF = BRDF_Lambert( material.diffuseContribution );
	#endif
	reflectedLight.directDiffuse += irradiance * diffuseBRDF * ( 1.0 - F );
}
void RE_IndirectDiffuse_Physical( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 singleScattering = vec3( 0.0 );
	vec3 multiScattering = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScattering, multiScattering );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScattering, multiScattering );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuseAlbedo = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness );
		vec3 diffuse = irradiance * RECIPROCAL_PI * diffuseAlbedo * ( 1.0 - singleScattering - multiScattering );
	#else
		vec3 diffuse = irradiance * BRDF_Lambert( material.diffuseContribution ) * ( 1.0 - singleScattering - multiScattering );
	#endif
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		sheenSpecularIndirect += irradiance * material.sheenColor * sheenAlbedo * RECIPROCAL_PI;
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		diffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectDiffuse += diffuse;
}
void RE_IndirectSpecular_Physical( const in vec3 radiance, const in vec3 irradiance, const in vec3 clearcoatRadiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight) {
	#ifdef USE_CLEARCOAT
		clearcoatSpecularIndirect += clearcoatRadiance * EnvironmentBRDF( geometryClearcoatNormal, geometryViewDir, material.clearcoatF0, material.clearcoatF90, material.clearcoatRoughness );
	#endif
	#ifdef USE_SHEEN
		sheenSpecularIndirect += irradiance * material.sheenColor * IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness ) * RECIPROCAL_PI;
 	#endif
	vec3 singleScatteringDielectric = vec3( 0.0 );
	vec3 multiScatteringDielectric = vec3( 0.0 );
	vec3 singleScatteringMetallic = vec3( 0.0 );
	vec3 multiScatteringMetallic = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscatteringIridescence( material.dfg, material.diffuseColor, material.specularF90, material.iridescence, material.iridescenceF0Metallic, singleScatteringMetallic, multiScatteringMetallic );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscattering( material.dfg, material.diffuseColor, material.specularF90, singleScatteringMetallic, multiScatteringMetallic );
	#endif
	vec3 singleScattering = mix( singleScatteringDielectric, singleScatteringMetallic, material.metalness );
	vec3 multiScattering = mix( multiScatteringDielectric, multiScatteringMetallic, material.metalness );
	vec3 totalScatteringDielectric = singleScatteringDielectric + multiScatteringDielectric;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuse = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness ) * ( 1.0 - totalScatteringDielectric );
	#else
		vec3 diffuse = material.diffuseContribution * ( 1.0 - totalScatteringDielectric );
	#endif
	vec3 cosineWeightedIrradiance = irradiance * RECIPROCAL_PI;
	vec3 indirectSpecular = radiance * singleScattering;
	indirectSpecular += multiScattering * cosineWeightedIrradiance;
	vec3 indirectDiffuse = diffuse * cosineWeightedIrradiance;
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		indirectSpecular *= sheenEnergyComp;
		indirectDiffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectSpecular += indirectSpecular;
	reflectedLight.indirectDiffuse += indirectDiffuse;
}
#define RE_Direct				RE_Direct_Physical
#define RE_Direct_RectArea		RE_Direct_RectArea_Physical
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Physical
#define RE_IndirectSpecular		RE_IndirectSpecular_Physical
float computeSpecularOcclusion( const in float dotNV, const in float ambientOcclusion, const in float roughness ) {
	return saturate( pow( dotNV + ambientOcclusion, exp2( - 16.0 * roughness - 1.0 ) ) - 1.0 + ambientOcclusion );
}`,Uv=`
vec3 geometryPosition = - vViewPosition;
vec3 geometryNormal = normal;
vec3 geometryViewDir = ( isOrthographic ) ? vec3( 0, 0, 1 ) : normalize( vViewPosition );
vec3 geometryClearcoatNormal = vec3( 0.0 );
#ifdef USE_CLEARCOAT
	geometryClearcoatNormal = clearcoatNormal;
#endif
#ifdef USE_IRIDESCENCE
	float dotNVi = saturate( dot( normal, geometryViewDir ) );
	if ( material.iridescenceThickness == 0.0 ) {
		material.iridescence = 0.0;
	} else {
		material.iridescence = saturate( material.iridescence );
	}
	if ( material.iridescence > 0.0 ) {
		vec3 iridescenceFresnelDielectric = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.specularColor );
		vec3 iridescenceFresnelMetallic = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.diffuseColor );
		material.iridescenceFresnel = mix( iridescenceFresnelDielectric, iridescenceFresnelMetallic, material.metalness );
		material.iridescenceF0Dielectric = Schlick_to_F0( iridescenceFresnelDielectric, 1.0, dotNVi );
		material.iridescenceF0Metallic = Schlick_to_F0( iridescenceFresnelMetallic, 1.0, dotNVi );
	}
#endif
#ifdef STANDARD
	float dotNVms = saturate( dot( geometryNormal, geometryViewDir ) );
	material.dfg = texture2D( dfgLUT, vec2( material.roughness, dotNVms ) ).rg;
	#if ( NUM_SUN_LIGHTS > 0 || NUM_DIR_LIGHTS > 0 || NUM_POINT_LIGHTS > 0 || NUM_SPOT_LIGHTS > 0 )
		float EssMs = material.dfg.x + material.dfg.y;
		material.multiScatteringCompensation = 1.0 + material.specularColorBlended * ( 1.0 / EssMs - 1.0 );
	#endif
#endif
IncidentLight directLight;
#if ( NUM_POINT_LIGHTS > 0 ) && defined( RE_Direct )
	PointLight pointLight;
	#if defined( USE_SHADOWMAP ) && NUM_POINT_LIGHT_SHADOWS > 0
	PointLightShadow pointLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHTS; i ++ ) {
		pointLight = pointLights[ i ];
		getPointLightInfo( pointLight, geometryPosition, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_POINT_LIGHT_SHADOWS ) && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
		pointLightShadow = pointLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getPointShadow( pointShadowMap[ i ], pointLightShadow.shadowMapSize, pointLightShadow.shadowIntensity, pointLightShadow.shadowBias, pointLightShadow.shadowRadius, vPointShadowCoord[ i ], pointLightShadow.shadowCameraNear, pointLightShadow.shadowCameraFar ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SPOT_LIGHTS > 0 ) && defined( RE_Direct )
	SpotLight spotLight;
	vec4 spotColor;
	vec3 spotLightCoord;
	bool inSpotLightMap;
	#if defined( USE_SHADOWMAP ) && NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHTS; i ++ ) {
		spotLight = spotLights[ i ];
		getSpotLightInfo( spotLight, geometryPosition, directLight );
		#if ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#define SPOT_LIGHT_MAP_INDEX UNROLLED_LOOP_INDEX
		#elif ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		#define SPOT_LIGHT_MAP_INDEX NUM_SPOT_LIGHT_MAPS
		#else
		#define SPOT_LIGHT_MAP_INDEX ( UNROLLED_LOOP_INDEX - NUM_SPOT_LIGHT_SHADOWS + NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#endif
		#if ( SPOT_LIGHT_MAP_INDEX < NUM_SPOT_LIGHT_MAPS )
			spotLightCoord = vSpotLightCoord[ i ].xyz / vSpotLightCoord[ i ].w;
			inSpotLightMap = all( lessThan( abs( spotLightCoord * 2. - 1. ), vec3( 1.0 ) ) );
			spotColor = texture2D( spotLightMap[ SPOT_LIGHT_MAP_INDEX ], spotLightCoord.xy );
			directLight.color = inSpotLightMap ? directLight.color * spotColor.rgb : directLight.color;
		#endif
		#undef SPOT_LIGHT_MAP_INDEX
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		spotLightShadow = spotLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( spotShadowMap[ i ], spotLightShadow.shadowMapSize, spotLightShadow.shadowIntensity, spotLightShadow.shadowBias, spotLightShadow.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SUN_LIGHTS > 0 ) && defined( RE_Direct )
	SunLight sunLight;
	#if defined( USE_SHADOWMAP ) && NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHTS; i ++ ) {
		sunLight = sunLights[ i ];
		getSunLightInfo( sunLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SUN_LIGHT_SHADOWS )
		sunLightShadow = sunLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getSunShadow( sunShadowMap[ i ], sunLightShadow, UNROLLED_LOOP_INDEX ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_DIR_LIGHTS > 0 ) && defined( RE_Direct )
	DirectionalLight directionalLight;
	#if defined( USE_SHADOWMAP ) && NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHTS; i ++ ) {
		directionalLight = directionalLights[ i ];
		getDirectionalLightInfo( directionalLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_DIR_LIGHT_SHADOWS )
		directionalLightShadow = directionalLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( directionalShadowMap[ i ], directionalLightShadow.shadowMapSize, directionalLightShadow.shadowIntensity, directionalLightShadow.shadowBias, directionalLightShadow.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_RECT_AREA_LIGHTS > 0 ) && defined( RE_Direct_RectArea )
	RectAreaLight rectAreaLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_RECT_AREA_LIGHTS; i ++ ) {
		rectAreaLight = rectAreaLights[ i ];
		RE_Direct_RectArea( rectAreaLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if defined( RE_IndirectDiffuse )
	vec3 iblIrradiance = vec3( 0.0 );
	vec3 irradiance = getAmbientLightIrradiance( ambientLightColor );
	#if defined( USE_LIGHT_PROBES )
		irradiance += getLightProbeIrradiance( lightProbe, geometryNormal );
	#endif
	#if ( NUM_HEMI_LIGHTS > 0 )
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_HEMI_LIGHTS; i ++ ) {
			irradiance += getHemisphereLightIrradiance( hemisphereLights[ i ], geometryNormal );
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_LIGHT_PROBE_GRIDS > 0
		vec3 probeWorldPos = ( ( vec4( geometryPosition, 1.0 ) - viewMatrix[ 3 ] ) * viewMatrix ).xyz;
		vec3 probeWorldNormal = transformNormalByInverseViewMatrix( geometryNormal, viewMatrix );
		int probeGrid = - 1;
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( isInsideLightProbeGrid( probeWorldPos, probeWorldNormal, probesMin[ i ], probesMax[ i ], probesResolution[ i ] ) ) probeGrid = UNROLLED_LOOP_INDEX;
		}
		#pragma unroll_loop_end
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( probeGrid == UNROLLED_LOOP_INDEX ) irradiance += getLightProbeGridIrradiance( probesSH[ i ], probesMin[ i ], probesMax[ i ], probesResolution[ i ], probeWorldPos, probeWorldNormal );
		}
		#pragma unroll_loop_end
	#endif
#endif
#if defined( RE_IndirectSpecular )
	vec3 radiance = vec3( 0.0 );
	vec3 clearcoatRadiance = vec3( 0.0 );
#endif`,Fv=`#if defined( RE_IndirectDiffuse )
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		vec3 lightMapIrradiance = lightMapTexel.rgb * lightMapIntensity;
		irradiance += lightMapIrradiance;
	#endif
	#if defined( USE_ENVMAP ) && defined( ENVMAP_TYPE_PMREM )
		#if defined( STANDARD ) || defined( LAMBERT ) || defined( PHONG )
			iblIrradiance += getIBLIrradiance( geometryNormal );
		#endif
	#endif
#endif
#if defined( USE_ENVMAP ) && defined( RE_IndirectSpecular )
	#ifdef USE_ANISOTROPY
		vec3 iblRadiance = getIBLAnisotropyRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
	#else
		vec3 iblRadiance = getIBLRadiance( geometryViewDir, geometryNormal, material.roughness );
	#endif
	#ifdef USE_RETROREFLECTION
		#ifdef USE_ANISOTROPY
			vec3 retroIBLRadiance = getIBLAnisotropyRetroRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
		#else
			vec3 retroIBLRadiance = getIBLRetroRadiance( geometryViewDir, geometryNormal, material.roughness );
		#endif
		iblRadiance = mix( iblRadiance, retroIBLRadiance, saturate( material.retroreflectivity ) );
	#endif
	radiance += iblRadiance;
	#ifdef USE_CLEARCOAT
		clearcoatRadiance += getIBLRadiance( geometryViewDir, geometryClearcoatNormal, material.clearcoatRoughness );
	#endif
#endif`,Ov=`#if defined( RE_IndirectDiffuse )
	#if defined( LAMBERT ) || defined( PHONG )
		irradiance += iblIrradiance;
	#endif
	RE_IndirectDiffuse( irradiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif
#if defined( RE_IndirectSpecular )
	RE_IndirectSpecular( radiance, iblIrradiance, clearcoatRadiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif`,kv=`#if NUM_LIGHT_PROBE_GRIDS > 0
uniform highp sampler3D probesSH[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMin[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMax[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesResolution[ NUM_LIGHT_PROBE_GRIDS ];
bool isInsideLightProbeGrid( vec3 worldPos, vec3 worldNormal, vec3 probesMin, vec3 probesMax, vec3 probesResolution ) {
	vec3 spacing = ( probesMax - probesMin ) / probesResolution;
	vec3 samplePos = worldPos + worldNormal * spacing * 0.5;
	vec3 margin = spacing * 0.01;
	return all( greaterThanEqual( samplePos, probesMin - margin ) ) && all( lessThanEqual( samplePos, probesMax + margin ) );
}
vec3 getLightProbeGridIrradiance( highp sampler3D probesSH, vec3 probesMin, vec3 probesMax, vec3 probesResolution, vec3 worldPos, vec3 worldNormal ) {
	vec3 res = probesResolution;
	vec3 gridRange = probesMax - probesMin;
	vec3 probeSpacing = gridRange / res;
	vec3 samplePos = worldPos + worldNormal * probeSpacing * 0.5;
	vec3 uvw = clamp( ( samplePos - probesMin ) / gridRange, 0.5 / res, 1.0 - 0.5 / res );
	float nz          = res.z;
	float paddedSlices = nz + 2.0;
	float atlasDepth  = 7.0 * paddedSlices;
	float uvZBase     = uvw.z * nz + 1.0;
	vec4 s0 = texture( probesSH, vec3( uvw.xy, ( uvZBase                       ) / atlasDepth ) );
	vec4 s1 = texture( probesSH, vec3( uvw.xy, ( uvZBase +       paddedSlices   ) / atlasDepth ) );
	vec4 s2 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 2.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s3 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 3.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s4 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 4.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s5 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 5.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s6 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 6.0 * paddedSlices   ) / atlasDepth ) );
	vec3 c0 = s0.xyz;
	vec3 c1 = vec3( s0.w, s1.xy );
	vec3 c2 = vec3( s1.zw, s2.x );
	vec3 c3 = s2.yzw;
	vec3 c4 = s3.xyz;
	vec3 c5 = vec3( s3.w, s4.xy );
	vec3 c6 = vec3( s4.zw, s5.x );
	vec3 c7 = s5.yzw;
	vec3 c8 = s6.xyz;
	float x = worldNormal.x, y = worldNormal.y, z = worldNormal.z;
	vec3 result = c0 * 0.886227;
	result += c1 * 2.0 * 0.511664 * y;
	result += c2 * 2.0 * 0.511664 * z;
	result += c3 * 2.0 * 0.511664 * x;
	result += c4 * 2.0 * 0.429043 * x * y;
	result += c5 * 2.0 * 0.429043 * y * z;
	result += c6 * ( 0.743125 * z * z - 0.247708 );
	result += c7 * 2.0 * 0.429043 * x * z;
	result += c8 * 0.429043 * ( x * x - y * y );
	return max( result, vec3( 0.0 ) );
}
#endif`,Bv=`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	gl_FragDepth = vIsPerspective == 0.0 ? gl_FragCoord.z : log2( vFragDepth ) * logDepthBufFC * 0.5;
#endif`,zv=`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	uniform float logDepthBufFC;
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,Hv=`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,Gv=`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	vFragDepth = 1.0 + gl_Position.w;
	vIsPerspective = float( isPerspectiveMatrix( projectionMatrix ) );
#endif`,Vv=`#ifdef USE_MAP
	vec4 sampledDiffuseColor = texture2D( map, vMapUv );
	#ifdef DECODE_VIDEO_TEXTURE
		sampledDiffuseColor = sRGBTransferEOTF( sampledDiffuseColor );
	#endif
	diffuseColor *= sampledDiffuseColor;
#endif`,Wv=`#ifdef USE_MAP
	uniform sampler2D map;
#endif`,Xv=`#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
	#if defined( USE_POINTS_UV )
		vec2 uv = vUv;
	#else
		vec2 uv = ( uvTransform * vec3( gl_PointCoord.x, 1.0 - gl_PointCoord.y, 1 ) ).xy;
	#endif
#endif
#ifdef USE_MAP
	diffuseColor *= texture2D( map, uv );
#endif
#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, uv ).g;
#endif`,$v=`#if defined( USE_POINTS_UV )
	varying vec2 vUv;
#else
	#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
		uniform mat3 uvTransform;
	#endif
#endif
#ifdef USE_MAP
	uniform sampler2D map;
#endif
#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,Yv=`float metalnessFactor = metalness;
#ifdef USE_METALNESSMAP
	vec4 texelMetalness = texture2D( metalnessMap, vMetalnessMapUv );
	metalnessFactor *= texelMetalness.b;
#endif`,qv=`#ifdef USE_METALNESSMAP
	uniform sampler2D metalnessMap;
#endif`,Kv=`#ifdef USE_INSTANCING_MORPH
	float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	float morphTargetBaseInfluence = texelFetch( morphTexture, ivec2( 0, gl_InstanceID ), 0 ).r;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		morphTargetInfluences[i] =  texelFetch( morphTexture, ivec2( i + 1, gl_InstanceID ), 0 ).r;
	}
#endif`,Zv=`#if defined( USE_MORPHCOLORS )
	#if defined( USE_COLOR_ALPHA )
		vColor *= morphTargetBaseInfluence;
	#elif defined( USE_COLOR )
		vColor.rgb *= morphTargetBaseInfluence;
	#endif
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		#if defined( USE_COLOR_ALPHA )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor += getMorph( gl_VertexID, i, 2 ) * morphTargetInfluences[ i ];
		#elif defined( USE_COLOR )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor.rgb += getMorph( gl_VertexID, i, 2 ).rgb * morphTargetInfluences[ i ];
		#endif
	}
#endif`,Jv=`#ifdef USE_MORPHNORMALS
	objectNormal *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) objectNormal += getMorph( gl_VertexID, i, 1 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,Qv=`#ifdef USE_MORPHTARGETS
	#ifndef USE_INSTANCING_MORPH
		uniform float morphTargetBaseInfluence;
		uniform float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	#endif
	uniform sampler2DArray morphTargetsTexture;
	uniform ivec2 morphTargetsTextureSize;
	vec4 getMorph( const in int vertexIndex, const in int morphTargetIndex, const in int offset ) {
		int texelIndex = vertexIndex * MORPHTARGETS_TEXTURE_STRIDE + offset;
		int y = texelIndex / morphTargetsTextureSize.x;
		int x = texelIndex - y * morphTargetsTextureSize.x;
		ivec3 morphUV = ivec3( x, y, morphTargetIndex );
		return texelFetch( morphTargetsTexture, morphUV, 0 );
	}
#endif`,jv=`#ifdef USE_MORPHTARGETS
	transformed *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) transformed += getMorph( gl_VertexID, i, 0 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,tM=`float faceDirection = gl_FrontFacing ? 1.0 : - 1.0;
#ifdef FLAT_SHADED
	vec3 fdx = dFdx( vViewPosition );
	vec3 fdy = dFdy( vViewPosition );
	vec3 normal = normalize( cross( fdx, fdy ) );
#else
	vec3 normal = normalize( vNormal );
	#ifdef DOUBLE_SIDED
		normal *= faceDirection;
	#endif
#endif
#if defined( USE_NORMALMAP_TANGENTSPACE ) || defined( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY )
	#ifdef USE_TANGENT
		mat3 tbn = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn = getTangentFrame( - vViewPosition, normal,
		#if defined( USE_NORMALMAP )
			vNormalMapUv
		#elif defined( USE_CLEARCOAT_NORMALMAP )
			vClearcoatNormalMapUv
		#else
			vUv
		#endif
		);
	#endif
	#ifdef DOUBLE_SIDED
		tbn[0] *= faceDirection;
		tbn[1] *= faceDirection;
	#endif
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	#ifdef USE_TANGENT
		mat3 tbn2 = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn2 = getTangentFrame( - vViewPosition, normal, vClearcoatNormalMapUv );
	#endif
	#ifdef DOUBLE_SIDED
		tbn2[0] *= faceDirection;
		tbn2[1] *= faceDirection;
	#endif
#endif
vec3 nonPerturbedNormal = normal;`,eM=`#ifdef USE_NORMALMAP_OBJECTSPACE
	normal = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#ifdef FLIP_SIDED
		normal = - normal;
	#endif
	#ifdef DOUBLE_SIDED
		normal = normal * faceDirection;
	#endif
	normal = normalize( normalMatrix * normal );
#elif defined( USE_NORMALMAP_TANGENTSPACE )
	vec3 mapN = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#if defined( USE_PACKED_NORMALMAP )
		mapN = vec3( mapN.xy, sqrt( saturate( 1.0 - dot( mapN.xy, mapN.xy ) ) ) );
	#endif
	mapN.xy *= normalScale;
	normal = normalize( tbn * mapN );
#elif defined( USE_BUMPMAP )
	normal = perturbNormalArb( - vViewPosition, normal, dHdxy_fwd(), faceDirection );
#endif`,nM=`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,iM=`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,sM=`#ifndef FLAT_SHADED
	vNormal = normalize( transformedNormal );
	#ifdef USE_TANGENT
		vTangent = normalize( transformedTangent );
		vBitangent = normalize( cross( vNormal, vTangent ) * tangent.w );
		#ifdef FLIP_SIDED
			vBitangent = - vBitangent;
		#endif
	#endif
#endif`,rM=`#ifdef USE_NORMALMAP
	uniform sampler2D normalMap;
	uniform vec2 normalScale;
#endif
#ifdef USE_NORMALMAP_OBJECTSPACE
	uniform mat3 normalMatrix;
#endif
#if ! defined ( USE_TANGENT ) && ( defined ( USE_NORMALMAP_TANGENTSPACE ) || defined ( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY ) )
	mat3 getTangentFrame( vec3 eye_pos, vec3 surf_norm, vec2 uv ) {
		vec3 q0 = dFdx( eye_pos.xyz );
		vec3 q1 = dFdy( eye_pos.xyz );
		vec2 st0 = dFdx( uv.st );
		vec2 st1 = dFdy( uv.st );
		vec3 N = surf_norm;
		vec3 q1perp = cross( q1, N );
		vec3 q0perp = cross( N, q0 );
		vec3 T = q1perp * st0.x + q0perp * st1.x;
		vec3 B = q1perp * st0.y + q0perp * st1.y;
		float det = max( dot( T, T ), dot( B, B ) );
		float scale = ( det == 0.0 ) ? 0.0 : inversesqrt( det );
		return mat3( T * scale, B * scale, N );
	}
#endif`,aM=`#ifdef USE_CLEARCOAT
	vec3 clearcoatNormal = nonPerturbedNormal;
#endif`,oM=`#ifdef USE_CLEARCOAT_NORMALMAP
	vec3 clearcoatMapN = texture2D( clearcoatNormalMap, vClearcoatNormalMapUv ).xyz * 2.0 - 1.0;
	clearcoatMapN.xy *= clearcoatNormalScale;
	clearcoatNormal = normalize( tbn2 * clearcoatMapN );
#endif`,lM=`#ifdef USE_CLEARCOATMAP
	uniform sampler2D clearcoatMap;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform sampler2D clearcoatNormalMap;
	uniform vec2 clearcoatNormalScale;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform sampler2D clearcoatRoughnessMap;
#endif`,cM=`#ifdef USE_IRIDESCENCEMAP
	uniform sampler2D iridescenceMap;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform sampler2D iridescenceThicknessMap;
#endif`,hM=`#ifdef OPAQUE
diffuseColor.a = 1.0;
#endif
#ifdef USE_TRANSMISSION
diffuseColor.a *= material.transmissionAlpha;
#endif
gl_FragColor = vec4( outgoingLight, diffuseColor.a );`,uM=`vec3 packNormalToRGB( const in vec3 normal ) {
	return normalize( normal ) * 0.5 + 0.5;
}
vec3 unpackRGBToNormal( const in vec3 rgb ) {
	return 2.0 * rgb.xyz - 1.0;
}
const float PackUpscale = 256. / 255.;const float UnpackDownscale = 255. / 256.;const float ShiftRight8 = 1. / 256.;
const float Inv255 = 1. / 255.;
const vec4 PackFactors = vec4( 1.0, 256.0, 256.0 * 256.0, 256.0 * 256.0 * 256.0 );
const vec2 UnpackFactors2 = vec2( UnpackDownscale, 1.0 / PackFactors.g );
const vec3 UnpackFactors3 = vec3( UnpackDownscale / PackFactors.rg, 1.0 / PackFactors.b );
const vec4 UnpackFactors4 = vec4( UnpackDownscale / PackFactors.rgb, 1.0 / PackFactors.a );
vec4 packDepthToRGBA( const in float v ) {
	if( v <= 0.0 )
		return vec4( 0., 0., 0., 0. );
	if( v >= 1.0 )
		return vec4( 1., 1., 1., 1. );
	float vuf;
	float af = modf( v * PackFactors.a, vuf );
	float bf = modf( vuf * ShiftRight8, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec4( vuf * Inv255, gf * PackUpscale, bf * PackUpscale, af );
}
vec3 packDepthToRGB( const in float v ) {
	if( v <= 0.0 )
		return vec3( 0., 0., 0. );
	if( v >= 1.0 )
		return vec3( 1., 1., 1. );
	float vuf;
	float bf = modf( v * PackFactors.b, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec3( vuf * Inv255, gf * PackUpscale, bf );
}
vec2 packDepthToRG( const in float v ) {
	if( v <= 0.0 )
		return vec2( 0., 0. );
	if( v >= 1.0 )
		return vec2( 1., 1. );
	float vuf;
	float gf = modf( v * 256., vuf );
	return vec2( vuf * Inv255, gf );
}
float unpackRGBAToDepth( const in vec4 v ) {
	return dot( v, UnpackFactors4 );
}
float unpackRGBToDepth( const in vec3 v ) {
	return dot( v, UnpackFactors3 );
}
float unpackRGToDepth( const in vec2 v ) {
	return v.r * UnpackFactors2.r + v.g * UnpackFactors2.g;
}
vec4 pack2HalfToRGBA( const in vec2 v ) {
	vec4 r = vec4( v.x, fract( v.x * 255.0 ), v.y, fract( v.y * 255.0 ) );
	return vec4( r.x - r.y / 255.0, r.y, r.z - r.w / 255.0, r.w );
}
vec2 unpackRGBATo2Half( const in vec4 v ) {
	return vec2( v.x + ( v.y / 255.0 ), v.z + ( v.w / 255.0 ) );
}
float viewZToOrthographicDepth( const in float viewZ, const in float near, const in float far ) {
	return ( viewZ + near ) / ( near - far );
}
float orthographicDepthToViewZ( const in float depth, const in float near, const in float far ) {
	#ifdef USE_REVERSED_DEPTH_BUFFER
	
		return depth * ( far - near ) - far;
	#else
		return depth * ( near - far ) - near;
	#endif
}
float viewZToPerspectiveDepth( const in float viewZ, const in float near, const in float far ) {
	return ( ( near + viewZ ) * far ) / ( ( far - near ) * viewZ );
}
float perspectiveDepthToViewZ( const in float depth, const in float near, const in float far ) {
	
	#ifdef USE_REVERSED_DEPTH_BUFFER
		return ( near * far ) / ( ( near - far ) * depth - near );
	#else
		return ( near * far ) / ( ( far - near ) * depth - far );
	#endif
}`,fM=`#ifdef PREMULTIPLIED_ALPHA
	gl_FragColor.rgb *= gl_FragColor.a;
#endif`,dM=`vec4 mvPosition = vec4( transformed, 1.0 );
#ifdef USE_BATCHING
	mvPosition = batchingMatrix * mvPosition;
#endif
#ifdef USE_INSTANCING
	mvPosition = instanceMatrix * mvPosition;
#endif
mvPosition = modelViewMatrix * mvPosition;
gl_Position = projectionMatrix * mvPosition;`,pM=`#ifdef DITHERING
	gl_FragColor.rgb = dithering( gl_FragColor.rgb );
#endif`,mM=`#ifdef DITHERING
	vec3 dithering( vec3 color ) {
		float grid_position = rand( gl_FragCoord.xy );
		vec3 dither_shift_RGB = vec3( 0.25 / 255.0, -0.25 / 255.0, 0.25 / 255.0 );
		dither_shift_RGB = mix( 2.0 * dither_shift_RGB, -2.0 * dither_shift_RGB, grid_position );
		return color + dither_shift_RGB;
	}
#endif`,gM=`float roughnessFactor = roughness;
#ifdef USE_ROUGHNESSMAP
	vec4 texelRoughness = texture2D( roughnessMap, vRoughnessMapUv );
	roughnessFactor *= texelRoughness.g;
#endif`,_M=`#ifdef USE_ROUGHNESSMAP
	uniform sampler2D roughnessMap;
#endif`,xM=`#if NUM_SPOT_LIGHT_COORDS > 0
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#if NUM_SPOT_LIGHT_MAPS > 0
	uniform sampler2D spotLightMap[ NUM_SPOT_LIGHT_MAPS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		#define SUN_LIGHT_CASCADES 2
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#else
			uniform sampler2D sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#endif
		uniform mat4 sunShadowMatrix[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		uniform vec4 sunShadowCascade[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
		struct SunLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SunLightShadow sunLightShadows[ NUM_SUN_LIGHT_SHADOWS ];
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#else
			uniform sampler2D directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#endif
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#else
			uniform sampler2D spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#endif
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform samplerCubeShadow pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#elif defined( SHADOWMAP_TYPE_BASIC )
			uniform samplerCube pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#endif
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float interleavedGradientNoise( vec2 position ) {
			return fract( 52.9829189 * fract( dot( position, vec2( 0.06711056, 0.00583715 ) ) ) );
		}
		vec2 vogelDiskSample( int sampleIndex, int samplesCount, float phi ) {
			const float goldenAngle = 2.399963229728653;
			float r = sqrt( ( float( sampleIndex ) + 0.5 ) / float( samplesCount ) );
			float theta = float( sampleIndex ) * goldenAngle + phi;
			return vec2( cos( theta ), sin( theta ) ) * r;
		}
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float getShadow( sampler2DShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 texelSize = vec2( 1.0 ) / shadowMapSize;
				vec2 radius = shadowRadius * texelSize;
				float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
				shadow = (
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 0, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 1, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 2, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 3, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 4, 5, phi ) * radius, shadowCoord.z ) )
				) * 0.2;
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#elif defined( SHADOWMAP_TYPE_VSM )
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 distribution = texture2D( shadowMap, shadowCoord.xy ).rg;
				float mean = distribution.x;
				float variance = distribution.y * distribution.y;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					float hard_shadow = step( mean, shadowCoord.z );
				#else
					float hard_shadow = step( shadowCoord.z, mean );
				#endif
				
				if ( hard_shadow == 1.0 ) {
					shadow = 1.0;
				} else {
					variance = max( variance, 0.0000001 );
					float d = shadowCoord.z - mean;
					float p_max = variance / ( variance + d * d );
					p_max = clamp( ( p_max - 0.3 ) / 0.65, 0.0, 1.0 );
					shadow = max( hard_shadow, p_max );
				}
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#else
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				float depth = texture2D( shadowMap, shadowCoord.xy ).r;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					shadow = step( depth, shadowCoord.z );
				#else
					shadow = step( shadowCoord.z, depth );
				#endif
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#endif
	#if NUM_SUN_LIGHT_SHADOWS > 0
		float getSunShadow(
			#if defined( SHADOWMAP_TYPE_PCF )
				sampler2DShadow shadowMap,
			#else
				sampler2D shadowMap,
			#endif
			SunLightShadow sunLightShadow,
			int shadowIndex
		) {
			vec4 shadowWorldPosition = vec4( vSunShadowWorldPosition.xyz + vSunShadowWorldNormal * sunLightShadow.shadowNormalBias, 1.0 );
			float viewDepth = vSunShadowWorldPosition.w;
			int cascadeOffset = shadowIndex * SUN_LIGHT_CASCADES;
			float shadow = 1.0;
			for ( int i = SUN_LIGHT_CASCADES - 1; i >= 0; i -- ) {
				vec4 cascade = sunShadowCascade[ cascadeOffset + i ];
				if ( viewDepth >= cascade.x && viewDepth < cascade.y ) {
					float cascadeShadow = getShadow(
						shadowMap,
						sunLightShadow.shadowMapSize,
						sunLightShadow.shadowIntensity,
						sunLightShadow.shadowBias,
						sunLightShadow.shadowRadius,
						sunShadowMatrix[ cascadeOffset + i ] * shadowWorldPosition
					);
					shadow = mix( cascadeShadow, shadow, smoothstep( cascade.z, cascade.y, viewDepth ) );
				}
			}
			return shadow;
		}
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
	#if defined( SHADOWMAP_TYPE_PCF )
	float getPointShadow( samplerCubeShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 bd3D = normalize( lightToPosition );
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float lightDistance = length( lightToPosition );
			float depthRange = shadowCameraFar - shadowCameraNear;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				float depthA = - shadowCameraNear / depthRange - shadowBias;
				float depthB = shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#else
				float depthA = shadowCameraFar / depthRange + shadowBias;
				float depthB = - shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#endif
			float texelSize = shadowRadius / shadowMapSize.x;
			vec3 absDir = abs( bd3D );
			vec3 tangent = absDir.x > absDir.z ? vec3( 0.0, 1.0, 0.0 ) : vec3( 1.0, 0.0, 0.0 );
			tangent = normalize( cross( bd3D, tangent ) );
			vec3 bitangent = cross( bd3D, tangent );
			float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
			shadow = 0.0;
			for ( int i = 0; i < 5; i ++ ) {
				vec2 offset = vogelDiskSample( i, 5, phi );
				vec3 direction = bd3D + ( tangent * offset.x + bitangent * offset.y ) * texelSize;
				vec3 absDirection = abs( direction );
				float dp = depthA + depthB / max( max( absDirection.x, absDirection.y ), absDirection.z );
				shadow += texture( shadowMap, vec4( direction, dp ) );
			}
			shadow *= 0.2;
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#elif defined( SHADOWMAP_TYPE_BASIC )
	float getPointShadow( samplerCube shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float dp = ( shadowCameraFar * ( viewSpaceZ - shadowCameraNear ) ) / ( viewSpaceZ * ( shadowCameraFar - shadowCameraNear ) );
			dp += shadowBias;
			vec3 bd3D = normalize( lightToPosition );
			float depth = textureCube( shadowMap, bd3D ).r;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				depth = 1.0 - depth;
			#endif
			shadow = step( dp, depth );
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#endif
	#endif
#endif`,vM=`#if NUM_SPOT_LIGHT_COORDS > 0
	uniform mat4 spotLightMatrix[ NUM_SPOT_LIGHT_COORDS ];
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		uniform mat4 directionalShadowMatrix[ NUM_DIR_LIGHT_SHADOWS ];
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		uniform mat4 pointShadowMatrix[ NUM_POINT_LIGHT_SHADOWS ];
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
#endif`,MM=`#if ( defined( USE_SHADOWMAP ) && ( NUM_DIR_LIGHT_SHADOWS > 0 || NUM_SUN_LIGHT_SHADOWS > 0 || NUM_POINT_LIGHT_SHADOWS > 0 ) ) || ( NUM_SPOT_LIGHT_COORDS > 0 )
	#ifdef HAS_NORMAL
		vec3 shadowWorldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
	#else
		vec3 shadowWorldNormal = vec3( 0.0 );
	#endif
	vec4 shadowWorldPosition;
#endif
#if defined( USE_SHADOWMAP )
	#if NUM_SUN_LIGHT_SHADOWS > 0
		vSunShadowWorldPosition = vec4( worldPosition.xyz, - mvPosition.z );
		vSunShadowWorldNormal = shadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * directionalLightShadows[ i ].shadowNormalBias, 0 );
			vDirectionalShadowCoord[ i ] = directionalShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * pointLightShadows[ i ].shadowNormalBias, 0 );
			vPointShadowCoord[ i ] = pointShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
#endif
#if NUM_SPOT_LIGHT_COORDS > 0
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_COORDS; i ++ ) {
		shadowWorldPosition = worldPosition;
		#if ( defined( USE_SHADOWMAP ) && UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
			shadowWorldPosition.xyz += shadowWorldNormal * spotLightShadows[ i ].shadowNormalBias;
		#endif
		vSpotLightCoord[ i ] = spotLightMatrix[ i ] * shadowWorldPosition;
	}
	#pragma unroll_loop_end
#endif`,SM=`float getShadowMask() {
	float shadow = 1.0;
	#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHT_SHADOWS; i ++ ) {
		sunLight = sunLightShadows[ i ];
		shadow *= receiveShadow ? getSunShadow( sunShadowMap[ i ], sunLight, UNROLLED_LOOP_INDEX ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
		directionalLight = directionalLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( directionalShadowMap[ i ], directionalLight.shadowMapSize, directionalLight.shadowIntensity, directionalLight.shadowBias, directionalLight.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_SHADOWS; i ++ ) {
		spotLight = spotLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( spotShadowMap[ i ], spotLight.shadowMapSize, spotLight.shadowIntensity, spotLight.shadowBias, spotLight.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0 && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
	PointLightShadow pointLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
		pointLight = pointLightShadows[ i ];
		shadow *= receiveShadow ? getPointShadow( pointShadowMap[ i ], pointLight.shadowMapSize, pointLight.shadowIntensity, pointLight.shadowBias, pointLight.shadowRadius, vPointShadowCoord[ i ], pointLight.shadowCameraNear, pointLight.shadowCameraFar ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#endif
	return shadow;
}`,yM=`#ifdef USE_SKINNING
	mat4 boneMatX = getBoneMatrix( skinIndex.x );
	mat4 boneMatY = getBoneMatrix( skinIndex.y );
	mat4 boneMatZ = getBoneMatrix( skinIndex.z );
	mat4 boneMatW = getBoneMatrix( skinIndex.w );
#endif`,EM=`#ifdef USE_SKINNING
	uniform mat4 bindMatrix;
	uniform mat4 bindMatrixInverse;
	uniform highp sampler2D boneTexture;
	mat4 getBoneMatrix( const in float i ) {
		int size = textureSize( boneTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( boneTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( boneTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( boneTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( boneTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
#endif`,bM=`#ifdef USE_SKINNING
	vec4 skinVertex = bindMatrix * vec4( transformed, 1.0 );
	vec4 skinned = vec4( 0.0 );
	skinned += boneMatX * skinVertex * skinWeight.x;
	skinned += boneMatY * skinVertex * skinWeight.y;
	skinned += boneMatZ * skinVertex * skinWeight.z;
	skinned += boneMatW * skinVertex * skinWeight.w;
	transformed = ( bindMatrixInverse * skinned ).xyz;
#endif`,wM=`#ifdef USE_SKINNING
	mat4 skinMatrix = mat4( 0.0 );
	skinMatrix += skinWeight.x * boneMatX;
	skinMatrix += skinWeight.y * boneMatY;
	skinMatrix += skinWeight.z * boneMatZ;
	skinMatrix += skinWeight.w * boneMatW;
	skinMatrix = bindMatrixInverse * skinMatrix * bindMatrix;
	objectNormal = vec4( skinMatrix * vec4( objectNormal, 0.0 ) ).xyz;
	#ifdef USE_TANGENT
		objectTangent = vec4( skinMatrix * vec4( objectTangent, 0.0 ) ).xyz;
	#endif
#endif`,TM=`float specularStrength;
#ifdef USE_SPECULARMAP
	vec4 texelSpecular = texture2D( specularMap, vSpecularMapUv );
	specularStrength = texelSpecular.r;
#else
	specularStrength = 1.0;
#endif`,AM=`#ifdef USE_SPECULARMAP
	uniform sampler2D specularMap;
#endif`,RM=`#if defined( TONE_MAPPING )
	gl_FragColor.rgb = toneMapping( gl_FragColor.rgb );
#endif`,CM=`#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
uniform float toneMappingExposure;
vec3 LinearToneMapping( vec3 color ) {
	return saturate( toneMappingExposure * color );
}
vec3 ReinhardToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	return saturate( color / ( vec3( 1.0 ) + color ) );
}
vec3 CineonToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	color = max( vec3( 0.0 ), color - 0.004 );
	return pow( ( color * ( 6.2 * color + 0.5 ) ) / ( color * ( 6.2 * color + 1.7 ) + 0.06 ), vec3( 2.2 ) );
}
vec3 RRTAndODTFit( vec3 v ) {
	vec3 a = v * ( v + 0.0245786 ) - 0.000090537;
	vec3 b = v * ( 0.983729 * v + 0.4329510 ) + 0.238081;
	return a / b;
}
vec3 ACESFilmicToneMapping( vec3 color ) {
	const mat3 ACESInputMat = mat3(
		vec3( 0.59719, 0.07600, 0.02840 ),		vec3( 0.35458, 0.90834, 0.13383 ),
		vec3( 0.04823, 0.01566, 0.83777 )
	);
	const mat3 ACESOutputMat = mat3(
		vec3(  1.60475, -0.10208, -0.00327 ),		vec3( -0.53108,  1.10813, -0.07276 ),
		vec3( -0.07367, -0.00605,  1.07602 )
	);
	color *= toneMappingExposure / 0.6;
	color = ACESInputMat * color;
	color = RRTAndODTFit( color );
	color = ACESOutputMat * color;
	return saturate( color );
}
const mat3 LINEAR_REC2020_TO_LINEAR_SRGB = mat3(
	vec3( 1.6605, - 0.1246, - 0.0182 ),
	vec3( - 0.5876, 1.1329, - 0.1006 ),
	vec3( - 0.0728, - 0.0083, 1.1187 )
);
const mat3 LINEAR_SRGB_TO_LINEAR_REC2020 = mat3(
	vec3( 0.6274, 0.0691, 0.0164 ),
	vec3( 0.3293, 0.9195, 0.0880 ),
	vec3( 0.0433, 0.0113, 0.8956 )
);
vec3 agxDefaultContrastApprox( vec3 x ) {
	vec3 x2 = x * x;
	vec3 x4 = x2 * x2;
	return + 15.5 * x4 * x2
		- 40.14 * x4 * x
		+ 31.96 * x4
		- 6.868 * x2 * x
		+ 0.4298 * x2
		+ 0.1191 * x
		- 0.00232;
}
vec3 AgXToneMapping( vec3 color ) {
	const mat3 AgXInsetMatrix = mat3(
		vec3( 0.856627153315983, 0.137318972929847, 0.11189821299995 ),
		vec3( 0.0951212405381588, 0.761241990602591, 0.0767994186031903 ),
		vec3( 0.0482516061458583, 0.101439036467562, 0.811302368396859 )
	);
	const mat3 AgXOutsetMatrix = mat3(
		vec3( 1.1271005818144368, - 0.1413297634984383, - 0.14132976349843826 ),
		vec3( - 0.11060664309660323, 1.157823702216272, - 0.11060664309660294 ),
		vec3( - 0.016493938717834573, - 0.016493938717834257, 1.2519364065950405 )
	);
	const float AgxMinEv = - 12.47393;	const float AgxMaxEv = 4.026069;
	color *= toneMappingExposure;
	color = LINEAR_SRGB_TO_LINEAR_REC2020 * color;
	color = AgXInsetMatrix * color;
	color = max( color, 1e-10 );	color = log2( color );
	color = ( color - AgxMinEv ) / ( AgxMaxEv - AgxMinEv );
	color = clamp( color, 0.0, 1.0 );
	color = agxDefaultContrastApprox( color );
	color = AgXOutsetMatrix * color;
	color = pow( max( vec3( 0.0 ), color ), vec3( 2.2 ) );
	color = LINEAR_REC2020_TO_LINEAR_SRGB * color;
	color = clamp( color, 0.0, 1.0 );
	return color;
}
vec3 NeutralToneMapping( vec3 color ) {
	const float StartCompression = 0.8 - 0.04;
	const float Desaturation = 0.15;
	color *= toneMappingExposure;
	float x = min( color.r, min( color.g, color.b ) );
	float offset = x < 0.08 ? x - 6.25 * x * x : 0.04;
	color -= offset;
	float peak = max( color.r, max( color.g, color.b ) );
	if ( peak < StartCompression ) return color;
	float d = 1. - StartCompression;
	float newPeak = 1. - d * d / ( peak + d - StartCompression );
	color *= newPeak / peak;
	float g = 1. - 1. / ( Desaturation * ( peak - newPeak ) + 1. );
	return mix( color, vec3( newPeak ), g );
}
vec3 CustomToneMapping( vec3 color ) { return color; }`,PM=`#ifdef USE_TRANSMISSION
	material.transmission = transmission;
	material.transmissionAlpha = 1.0;
	material.thickness = thickness;
	material.attenuationDistance = attenuationDistance;
	material.attenuationColor = attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		material.transmission *= texture2D( transmissionMap, vTransmissionMapUv ).r;
	#endif
	#ifdef USE_THICKNESSMAP
		material.thickness *= texture2D( thicknessMap, vThicknessMapUv ).g;
	#endif
	vec3 pos = vWorldPosition;
	vec3 v = normalize( cameraPosition - pos );
	vec3 n = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec4 transmitted = getIBLVolumeRefraction(
		n, v, material.roughness, material.diffuseContribution, material.specularColorBlended, material.specularF90,
		pos, modelMatrix, viewMatrix, projectionMatrix, material.dispersion, material.ior, material.thickness,
		material.attenuationColor, material.attenuationDistance );
	material.transmissionAlpha = mix( material.transmissionAlpha, transmitted.a, material.transmission );
	totalDiffuse = mix( totalDiffuse, transmitted.rgb, material.transmission );
#endif`,LM=`#ifdef USE_TRANSMISSION
	uniform float transmission;
	uniform float thickness;
	uniform float attenuationDistance;
	uniform vec3 attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		uniform sampler2D transmissionMap;
	#endif
	#ifdef USE_THICKNESSMAP
		uniform sampler2D thicknessMap;
	#endif
	uniform vec2 transmissionSamplerSize;
	uniform sampler2D transmissionSamplerMap;
	uniform mat4 modelMatrix;
	uniform mat4 projectionMatrix;
	varying vec3 vWorldPosition;
	float w0( float a ) {
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - a + 3.0 ) - 3.0 ) + 1.0 );
	}
	float w1( float a ) {
		return ( 1.0 / 6.0 ) * ( a *  a * ( 3.0 * a - 6.0 ) + 4.0 );
	}
	float w2( float a ){
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - 3.0 * a + 3.0 ) + 3.0 ) + 1.0 );
	}
	float w3( float a ) {
		return ( 1.0 / 6.0 ) * ( a * a * a );
	}
	float g0( float a ) {
		return w0( a ) + w1( a );
	}
	float g1( float a ) {
		return w2( a ) + w3( a );
	}
	float h0( float a ) {
		return - 1.0 + w1( a ) / ( w0( a ) + w1( a ) );
	}
	float h1( float a ) {
		return 1.0 + w3( a ) / ( w2( a ) + w3( a ) );
	}
	vec4 bicubic( sampler2D tex, vec2 uv, vec4 texelSize, float lod ) {
		uv = uv * texelSize.zw + 0.5;
		vec2 iuv = floor( uv );
		vec2 fuv = fract( uv );
		float g0x = g0( fuv.x );
		float g1x = g1( fuv.x );
		float h0x = h0( fuv.x );
		float h1x = h1( fuv.x );
		float h0y = h0( fuv.y );
		float h1y = h1( fuv.y );
		vec2 p0 = ( vec2( iuv.x + h0x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p1 = ( vec2( iuv.x + h1x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p2 = ( vec2( iuv.x + h0x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		vec2 p3 = ( vec2( iuv.x + h1x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		return g0( fuv.y ) * ( g0x * textureLod( tex, p0, lod ) + g1x * textureLod( tex, p1, lod ) ) +
			g1( fuv.y ) * ( g0x * textureLod( tex, p2, lod ) + g1x * textureLod( tex, p3, lod ) );
	}
	vec4 textureBicubic( sampler2D sampler, vec2 uv, float lod ) {
		vec2 fLodSize = vec2( textureSize( sampler, int( lod ) ) );
		vec2 cLodSize = vec2( textureSize( sampler, int( lod + 1.0 ) ) );
		vec2 fLodSizeInv = 1.0 / fLodSize;
		vec2 cLodSizeInv = 1.0 / cLodSize;
		vec4 fSample = bicubic( sampler, uv, vec4( fLodSizeInv, fLodSize ), floor( lod ) );
		vec4 cSample = bicubic( sampler, uv, vec4( cLodSizeInv, cLodSize ), ceil( lod ) );
		return mix( fSample, cSample, fract( lod ) );
	}
	vec3 getVolumeTransmissionRay( const in vec3 n, const in vec3 v, const in float thickness, const in float ior, const in mat4 modelMatrix ) {
		vec3 refractionVector = refract( - v, normalize( n ), 1.0 / ior );
		vec3 modelScale;
		modelScale.x = length( vec3( modelMatrix[ 0 ].xyz ) );
		modelScale.y = length( vec3( modelMatrix[ 1 ].xyz ) );
		modelScale.z = length( vec3( modelMatrix[ 2 ].xyz ) );
		return normalize( refractionVector ) * thickness * modelScale;
	}
	float applyIorToRoughness( const in float roughness, const in float ior ) {
		return roughness * clamp( ior * 2.0 - 2.0, 0.0, 1.0 );
	}
	vec4 getTransmissionSample( const in vec2 fragCoord, const in float roughness, const in float ior ) {
		float lod = log2( transmissionSamplerSize.x ) * applyIorToRoughness( roughness, ior );
		return textureBicubic( transmissionSamplerMap, fragCoord.xy, lod );
	}
	vec3 volumeAttenuation( const in float transmissionDistance, const in vec3 attenuationColor, const in float attenuationDistance ) {
		if ( isinf( attenuationDistance ) ) {
			return vec3( 1.0 );
		} else {
			vec3 attenuationCoefficient = -log( attenuationColor ) / attenuationDistance;
			vec3 transmittance = exp( - attenuationCoefficient * transmissionDistance );			return transmittance;
		}
	}
	vec4 getIBLVolumeRefraction( const in vec3 n, const in vec3 v, const in float roughness, const in vec3 diffuseColor,
		const in vec3 specularColor, const in float specularF90, const in vec3 position, const in mat4 modelMatrix,
		const in mat4 viewMatrix, const in mat4 projMatrix, const in float dispersion, const in float ior, const in float thickness,
		const in vec3 attenuationColor, const in float attenuationDistance ) {
		vec4 transmittedLight;
		vec3 transmittance;
		#ifdef USE_DISPERSION
			float halfSpread = ( ior - 1.0 ) * 0.025 * dispersion;
			vec3 iors = vec3( ior - halfSpread, ior, ior + halfSpread );
			for ( int i = 0; i < 3; i ++ ) {
				vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, iors[ i ], modelMatrix );
				vec3 refractedRayExit = position + transmissionRay;
				vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
				vec2 refractionCoords = ndcPos.xy / ndcPos.w;
				refractionCoords += 1.0;
				refractionCoords /= 2.0;
				vec4 transmissionSample = getTransmissionSample( refractionCoords, roughness, iors[ i ] );
				transmittedLight[ i ] = transmissionSample[ i ];
				transmittedLight.a += transmissionSample.a;
				transmittance[ i ] = diffuseColor[ i ] * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance )[ i ];
			}
			transmittedLight.a /= 3.0;
		#else
			vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, ior, modelMatrix );
			vec3 refractedRayExit = position + transmissionRay;
			vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
			vec2 refractionCoords = ndcPos.xy / ndcPos.w;
			refractionCoords += 1.0;
			refractionCoords /= 2.0;
			transmittedLight = getTransmissionSample( refractionCoords, roughness, ior );
			transmittance = diffuseColor * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance );
		#endif
		vec3 attenuatedColor = transmittance * transmittedLight.rgb;
		vec3 F = EnvironmentBRDF( n, v, specularColor, specularF90, roughness );
		float transmittanceFactor = ( transmittance.r + transmittance.g + transmittance.b ) / 3.0;
		return vec4( ( 1.0 - F ) * attenuatedColor, 1.0 - ( 1.0 - transmittedLight.a ) * transmittanceFactor );
	}
#endif`,DM=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_SPECULARMAP
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,NM=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	uniform mat3 mapTransform;
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	uniform mat3 alphaMapTransform;
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	uniform mat3 lightMapTransform;
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	uniform mat3 aoMapTransform;
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	uniform mat3 bumpMapTransform;
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	uniform mat3 normalMapTransform;
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_DISPLACEMENTMAP
	uniform mat3 displacementMapTransform;
	varying vec2 vDisplacementMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	uniform mat3 emissiveMapTransform;
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	uniform mat3 metalnessMapTransform;
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	uniform mat3 roughnessMapTransform;
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	uniform mat3 diffuseRoughnessMapTransform;
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	uniform mat3 anisotropyMapTransform;
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	uniform mat3 clearcoatMapTransform;
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform mat3 clearcoatNormalMapTransform;
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform mat3 clearcoatRoughnessMapTransform;
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	uniform mat3 sheenColorMapTransform;
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	uniform mat3 sheenRoughnessMapTransform;
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	uniform mat3 iridescenceMapTransform;
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform mat3 iridescenceThicknessMapTransform;
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SPECULARMAP
	uniform mat3 specularMapTransform;
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	uniform mat3 specularColorMapTransform;
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	uniform mat3 specularIntensityMapTransform;
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,IM=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	vUv = vec3( uv, 1 ).xy;
#endif
#ifdef USE_MAP
	vMapUv = ( mapTransform * vec3( MAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ALPHAMAP
	vAlphaMapUv = ( alphaMapTransform * vec3( ALPHAMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_LIGHTMAP
	vLightMapUv = ( lightMapTransform * vec3( LIGHTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_AOMAP
	vAoMapUv = ( aoMapTransform * vec3( AOMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_BUMPMAP
	vBumpMapUv = ( bumpMapTransform * vec3( BUMPMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_NORMALMAP
	vNormalMapUv = ( normalMapTransform * vec3( NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DISPLACEMENTMAP
	vDisplacementMapUv = ( displacementMapTransform * vec3( DISPLACEMENTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_EMISSIVEMAP
	vEmissiveMapUv = ( emissiveMapTransform * vec3( EMISSIVEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_METALNESSMAP
	vMetalnessMapUv = ( metalnessMapTransform * vec3( METALNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ROUGHNESSMAP
	vRoughnessMapUv = ( roughnessMapTransform * vec3( ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	vDiffuseRoughnessMapUv = ( diffuseRoughnessMapTransform * vec3( DIFFUSE_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ANISOTROPYMAP
	vAnisotropyMapUv = ( anisotropyMapTransform * vec3( ANISOTROPYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOATMAP
	vClearcoatMapUv = ( clearcoatMapTransform * vec3( CLEARCOATMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	vClearcoatNormalMapUv = ( clearcoatNormalMapTransform * vec3( CLEARCOAT_NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	vClearcoatRoughnessMapUv = ( clearcoatRoughnessMapTransform * vec3( CLEARCOAT_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCEMAP
	vIridescenceMapUv = ( iridescenceMapTransform * vec3( IRIDESCENCEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	vIridescenceThicknessMapUv = ( iridescenceThicknessMapTransform * vec3( IRIDESCENCE_THICKNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_COLORMAP
	vSheenColorMapUv = ( sheenColorMapTransform * vec3( SHEEN_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	vSheenRoughnessMapUv = ( sheenRoughnessMapTransform * vec3( SHEEN_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULARMAP
	vSpecularMapUv = ( specularMapTransform * vec3( SPECULARMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_COLORMAP
	vSpecularColorMapUv = ( specularColorMapTransform * vec3( SPECULAR_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	vSpecularIntensityMapUv = ( specularIntensityMapTransform * vec3( SPECULAR_INTENSITYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_TRANSMISSIONMAP
	vTransmissionMapUv = ( transmissionMapTransform * vec3( TRANSMISSIONMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_THICKNESSMAP
	vThicknessMapUv = ( thicknessMapTransform * vec3( THICKNESSMAP_UV, 1 ) ).xy;
#endif`,UM=`#if defined( USE_ENVMAP ) || defined( DISTANCE ) || defined ( USE_SHADOWMAP ) || defined ( USE_TRANSMISSION ) || NUM_SPOT_LIGHT_COORDS > 0
	vec4 worldPosition = vec4( transformed, 1.0 );
	#ifdef USE_BATCHING
		worldPosition = batchingMatrix * worldPosition;
	#endif
	#ifdef USE_INSTANCING
		worldPosition = instanceMatrix * worldPosition;
	#endif
	worldPosition = modelMatrix * worldPosition;
#endif`;const FM=`varying vec2 vUv;
uniform mat3 uvTransform;
void main() {
	vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	gl_Position = vec4( position.xy, 1.0, 1.0 );
}`,OM=`uniform sampler2D t2D;
uniform float backgroundIntensity;
varying vec2 vUv;
void main() {
	vec4 texColor = texture2D( t2D, vUv );
	#ifdef DECODE_VIDEO_TEXTURE
		texColor = vec4( mix( pow( texColor.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), texColor.rgb * 0.0773993808, vec3( lessThanEqual( texColor.rgb, vec3( 0.04045 ) ) ) ), texColor.w );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,kM=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,BM=`uniform float backgroundBlurriness;
uniform float backgroundIntensity;
uniform mat3 backgroundRotation;
varying vec3 vWorldDirection;
#include <envmap_common_pars_fragment>
void main() {
	#ifdef ENVMAP_TYPE_PMREM
		vec4 texColor = textureLod( envMap, backgroundRotation * vWorldDirection, roughnessToMip( backgroundBlurriness ) );
	#else
		vec4 texColor = textureCube( envMap, backgroundRotation * vWorldDirection );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,zM=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,HM=`uniform samplerCube tCube;
uniform float tFlip;
uniform float opacity;
varying vec3 vWorldDirection;
void main() {
	vec4 texColor = textureCube( tCube, vec3( tFlip * vWorldDirection.x, vWorldDirection.yz ) );
	gl_FragColor = texColor;
	gl_FragColor.a *= opacity;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,GM=`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
varying vec2 vHighPrecisionZW;
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vHighPrecisionZW = gl_Position.zw;
}`,VM=`#if DEPTH_PACKING == 3200
	uniform float opacity;
#endif
#include <common>
#include <packing>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
varying vec2 vHighPrecisionZW;
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#if DEPTH_PACKING == 3200
		diffuseColor.a = opacity;
	#endif
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <logdepthbuf_fragment>
	#ifdef USE_REVERSED_DEPTH_BUFFER
		float fragCoordZ = vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ];
	#else
		float fragCoordZ = 0.5 * vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ] + 0.5;
	#endif
	#if DEPTH_PACKING == 3200
		gl_FragColor = vec4( vec3( 1.0 - fragCoordZ ), opacity );
	#elif DEPTH_PACKING == 3201
		gl_FragColor = packDepthToRGBA( fragCoordZ );
	#elif DEPTH_PACKING == 3202
		gl_FragColor = vec4( packDepthToRGB( fragCoordZ ), 1.0 );
	#elif DEPTH_PACKING == 3203
		gl_FragColor = vec4( packDepthToRG( fragCoordZ ), 0.0, 1.0 );
	#endif
}`,WM=`#define DISTANCE
varying vec3 vWorldPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <worldpos_vertex>
	#include <clipping_planes_vertex>
	vWorldPosition = worldPosition.xyz;
}`,XM=`#define DISTANCE
uniform vec3 referencePosition;
uniform float nearDistance;
uniform float farDistance;
varying vec3 vWorldPosition;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	float dist = length( vWorldPosition - referencePosition );
	dist = ( dist - nearDistance ) / ( farDistance - nearDistance );
	dist = saturate( dist );
	gl_FragColor = vec4( dist, 0.0, 0.0, 1.0 );
}`,$M=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
}`,YM=`uniform sampler2D tEquirect;
varying vec3 vWorldDirection;
#include <common>
void main() {
	vec3 direction = normalize( vWorldDirection );
	vec2 sampleUV = equirectUv( direction );
	gl_FragColor = texture2D( tEquirect, sampleUV );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,qM=`uniform float scale;
attribute float lineDistance;
varying float vLineDistance;
#include <common>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	vLineDistance = scale * lineDistance;
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,KM=`uniform vec3 diffuse;
uniform float opacity;
uniform float dashSize;
uniform float totalSize;
varying float vLineDistance;
#include <common>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	if ( mod( vLineDistance, totalSize ) > dashSize ) {
		discard;
	}
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,ZM=`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#if defined ( USE_ENVMAP ) || defined ( USE_SKINNING )
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinbase_vertex>
		#include <skinnormal_vertex>
		#include <defaultnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <fog_vertex>
}`,JM=`uniform vec3 diffuse;
uniform float opacity;
#ifndef FLAT_SHADED
	varying vec3 vNormal;
#endif
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <fog_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		reflectedLight.indirectDiffuse += lightMapTexel.rgb * lightMapIntensity * RECIPROCAL_PI;
	#else
		reflectedLight.indirectDiffuse += vec3( 1.0 );
	#endif
	#include <aomap_fragment>
	reflectedLight.indirectDiffuse *= diffuseColor.rgb;
	vec3 outgoingLight = reflectedLight.indirectDiffuse;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,QM=`#define LAMBERT
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,jM=`#define LAMBERT
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_lambert_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_lambert_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,tS=`#define MATCAP
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <displacementmap_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
	vViewPosition = - mvPosition.xyz;
}`,eS=`#define MATCAP
uniform vec3 diffuse;
uniform float opacity;
uniform sampler2D matcap;
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	vec3 viewDir = normalize( vViewPosition );
	vec3 x = normalize( vec3( viewDir.z, 0.0, - viewDir.x ) );
	vec3 y = cross( viewDir, x );
	vec2 uv = vec2( dot( x, normal ), dot( y, normal ) ) * 0.495 + 0.5;
	#ifdef USE_MATCAP
		vec4 matcapColor = texture2D( matcap, uv );
	#else
		vec4 matcapColor = vec4( vec3( mix( 0.2, 0.8, uv.y ) ), 1.0 );
	#endif
	vec3 outgoingLight = diffuseColor.rgb * matcapColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,nS=`#define NORMAL
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	vViewPosition = - mvPosition.xyz;
#endif
}`,iS=`#define NORMAL
uniform float opacity;
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <uv_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 0.0, 0.0, 0.0, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	gl_FragColor = vec4( normalize( normal ) * 0.5 + 0.5, diffuseColor.a );
	#ifdef OPAQUE
		gl_FragColor.a = 1.0;
	#endif
}`,sS=`#define PHONG
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,rS=`#define PHONG
uniform vec3 diffuse;
uniform vec3 emissive;
uniform vec3 specular;
uniform float shininess;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_phong_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_phong_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + reflectedLight.directSpecular + reflectedLight.indirectSpecular + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,aS=`#define STANDARD
varying vec3 vViewPosition;
#ifdef USE_TRANSMISSION
	varying vec3 vWorldPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
#ifdef USE_TRANSMISSION
	vWorldPosition = worldPosition.xyz;
#endif
}`,oS=`#define STANDARD
#ifdef PHYSICAL
	#define IOR
	#define USE_SPECULAR
#endif
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float roughness;
uniform float metalness;
uniform float opacity;
#ifdef IOR
	uniform float ior;
#endif
#ifdef USE_SPECULAR
	uniform float specularIntensity;
	uniform vec3 specularColor;
	#ifdef USE_SPECULAR_COLORMAP
		uniform sampler2D specularColorMap;
	#endif
	#ifdef USE_SPECULAR_INTENSITYMAP
		uniform sampler2D specularIntensityMap;
	#endif
#endif
#ifdef USE_CLEARCOAT
	uniform float clearcoat;
	uniform float clearcoatRoughness;
#endif
#ifdef USE_DIFFUSE_ROUGHNESS
	uniform float diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		uniform sampler2D diffuseRoughnessMap;
	#endif
#endif
#ifdef USE_DISPERSION
	uniform float dispersion;
#endif
#ifdef USE_RETROREFLECTION
	uniform float retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	uniform float iridescence;
	uniform float iridescenceIOR;
	uniform float iridescenceThicknessMinimum;
	uniform float iridescenceThicknessMaximum;
#endif
#ifdef USE_SHEEN
	uniform vec3 sheenColor;
	uniform float sheenRoughness;
	#ifdef USE_SHEEN_COLORMAP
		uniform sampler2D sheenColorMap;
	#endif
	#ifdef USE_SHEEN_ROUGHNESSMAP
		uniform sampler2D sheenRoughnessMap;
	#endif
#endif
#ifdef USE_ANISOTROPY
	uniform vec2 anisotropyVector;
	#ifdef USE_ANISOTROPYMAP
		uniform sampler2D anisotropyMap;
	#endif
#endif
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <iridescence_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_physical_pars_fragment>
#include <transmission_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <clearcoat_pars_fragment>
#include <iridescence_pars_fragment>
#include <roughnessmap_pars_fragment>
#include <metalnessmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <roughnessmap_fragment>
	#include <metalnessmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <clearcoat_normal_fragment_begin>
	#include <clearcoat_normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_physical_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 totalDiffuse = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse;
	vec3 totalSpecular = reflectedLight.directSpecular + reflectedLight.indirectSpecular;
	#include <transmission_fragment>
	vec3 outgoingLight = totalDiffuse + totalSpecular + totalEmissiveRadiance;
	#ifdef USE_SHEEN
 
		outgoingLight = outgoingLight + sheenSpecularDirect + sheenSpecularIndirect;
 
 	#endif
	#ifdef USE_CLEARCOAT
		float dotNVcc = saturate( dot( geometryClearcoatNormal, geometryViewDir ) );
		vec3 Fcc = F_Schlick( material.clearcoatF0, material.clearcoatF90, dotNVcc );
		outgoingLight = outgoingLight * ( 1.0 - material.clearcoat * Fcc ) + ( clearcoatSpecularDirect + clearcoatSpecularIndirect ) * material.clearcoat;
	#endif
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,lS=`#define TOON
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,cS=`#define TOON
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <gradientmap_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_toon_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_toon_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,hS=`uniform float size;
uniform float scale;
#include <common>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
#ifdef USE_POINTS_UV
	varying vec2 vUv;
	uniform mat3 uvTransform;
#endif
void main() {
	#ifdef USE_POINTS_UV
		vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	#endif
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	gl_PointSize = size;
	#ifdef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) gl_PointSize *= ( scale / - mvPosition.z );
	#endif
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <fog_vertex>
}`,uS=`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <color_pars_fragment>
#include <map_particle_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_particle_fragment>
	#include <color_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,fS=`#include <common>
#include <batching_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <shadowmap_pars_vertex>
void main() {
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,dS=`uniform vec3 color;
uniform float opacity;
#include <common>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <logdepthbuf_pars_fragment>
#include <shadowmap_pars_fragment>
#include <shadowmask_pars_fragment>
void main() {
	#include <logdepthbuf_fragment>
	gl_FragColor = vec4( color, opacity * ( 1.0 - getShadowMask() ) );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,pS=`uniform float rotation;
uniform vec2 center;
#include <common>
#include <uv_pars_vertex>
#include <fog_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	vec4 mvPosition = modelViewMatrix[ 3 ];
	vec2 scale = vec2( length( modelMatrix[ 0 ].xyz ), length( modelMatrix[ 1 ].xyz ) );
	#ifndef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) scale *= - mvPosition.z;
	#endif
	vec2 alignedPosition = ( position.xy - ( center - vec2( 0.5 ) ) ) * scale;
	vec2 rotatedPosition;
	rotatedPosition.x = cos( rotation ) * alignedPosition.x - sin( rotation ) * alignedPosition.y;
	rotatedPosition.y = sin( rotation ) * alignedPosition.x + cos( rotation ) * alignedPosition.y;
	mvPosition.xy += rotatedPosition;
	gl_Position = projectionMatrix * mvPosition;
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,mS=`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
}`,oe={alphahash_fragment:Ox,alphahash_pars_fragment:kx,alphamap_fragment:Bx,alphamap_pars_fragment:zx,alphatest_fragment:Hx,alphatest_pars_fragment:Gx,aomap_fragment:Vx,aomap_pars_fragment:Wx,batching_pars_vertex:Xx,batching_vertex:$x,begin_vertex:Yx,beginnormal_vertex:qx,bsdfs:Kx,iridescence_fragment:Zx,bumpmap_pars_fragment:Jx,clipping_planes_fragment:Qx,clipping_planes_pars_fragment:jx,clipping_planes_pars_vertex:tv,clipping_planes_vertex:ev,color_fragment:nv,color_pars_fragment:iv,color_pars_vertex:sv,color_vertex:rv,common:av,defaultnormal_vertex:ov,displacementmap_pars_vertex:lv,displacementmap_vertex:cv,emissivemap_fragment:hv,emissivemap_pars_fragment:uv,colorspace_fragment:fv,colorspace_pars_fragment:dv,envmap_fragment:pv,envmap_common_pars_fragment:mv,envmap_pars_fragment:gv,envmap_pars_vertex:_v,envmap_physical_pars_fragment:Rv,envmap_vertex:xv,fog_vertex:vv,fog_pars_vertex:Mv,fog_fragment:Sv,fog_pars_fragment:yv,gradientmap_pars_fragment:Ev,lightmap_pars_fragment:bv,lights_lambert_fragment:wv,lights_lambert_pars_fragment:Tv,lights_pars_begin:Av,lights_toon_fragment:Cv,lights_toon_pars_fragment:Pv,lights_phong_fragment:Lv,lights_phong_pars_fragment:Dv,lights_physical_fragment:Nv,lights_physical_pars_fragment:Iv,lights_fragment_begin:Uv,lights_fragment_maps:Fv,lights_fragment_end:Ov,lightprobes_pars_fragment:kv,logdepthbuf_fragment:Bv,logdepthbuf_pars_fragment:zv,logdepthbuf_pars_vertex:Hv,logdepthbuf_vertex:Gv,map_fragment:Vv,map_pars_fragment:Wv,map_particle_fragment:Xv,map_particle_pars_fragment:$v,metalnessmap_fragment:Yv,metalnessmap_pars_fragment:qv,morphinstance_vertex:Kv,morphcolor_vertex:Zv,morphnormal_vertex:Jv,morphtarget_pars_vertex:Qv,morphtarget_vertex:jv,normal_fragment_begin:tM,normal_fragment_maps:eM,normal_pars_fragment:nM,normal_pars_vertex:iM,normal_vertex:sM,normalmap_pars_fragment:rM,clearcoat_normal_fragment_begin:aM,clearcoat_normal_fragment_maps:oM,clearcoat_pars_fragment:lM,iridescence_pars_fragment:cM,opaque_fragment:hM,packing:uM,premultiplied_alpha_fragment:fM,project_vertex:dM,dithering_fragment:pM,dithering_pars_fragment:mM,roughnessmap_fragment:gM,roughnessmap_pars_fragment:_M,shadowmap_pars_fragment:xM,shadowmap_pars_vertex:vM,shadowmap_vertex:MM,shadowmask_pars_fragment:SM,skinbase_vertex:yM,skinning_pars_vertex:EM,skinning_vertex:bM,skinnormal_vertex:wM,specularmap_fragment:TM,specularmap_pars_fragment:AM,tonemapping_fragment:RM,tonemapping_pars_fragment:CM,transmission_fragment:PM,transmission_pars_fragment:LM,uv_pars_fragment:DM,uv_pars_vertex:NM,uv_vertex:IM,worldpos_vertex:UM,background_vert:FM,background_frag:OM,backgroundCube_vert:kM,backgroundCube_frag:BM,cube_vert:zM,cube_frag:HM,depth_vert:GM,depth_frag:VM,distance_vert:WM,distance_frag:XM,equirect_vert:$M,equirect_frag:YM,linedashed_vert:qM,linedashed_frag:KM,meshbasic_vert:ZM,meshbasic_frag:JM,meshlambert_vert:QM,meshlambert_frag:jM,meshmatcap_vert:tS,meshmatcap_frag:eS,meshnormal_vert:nS,meshnormal_frag:iS,meshphong_vert:sS,meshphong_frag:rS,meshphysical_vert:aS,meshphysical_frag:oS,meshtoon_vert:lS,meshtoon_frag:cS,points_vert:hS,points_frag:uS,shadow_vert:fS,shadow_frag:dS,sprite_vert:pS,sprite_frag:mS},Lt={common:{diffuse:{value:new se(16777215)},opacity:{value:1},map:{value:null},mapTransform:{value:new ne},alphaMap:{value:null},alphaMapTransform:{value:new ne},alphaTest:{value:0}},specularmap:{specularMap:{value:null},specularMapTransform:{value:new ne}},envmap:{envMap:{value:null},envMapRotation:{value:new ne},reflectivity:{value:1},ior:{value:1.5},refractionRatio:{value:.98},dfgLUT:{value:null}},aomap:{aoMap:{value:null},aoMapIntensity:{value:1},aoMapTransform:{value:new ne}},lightmap:{lightMap:{value:null},lightMapIntensity:{value:1},lightMapTransform:{value:new ne}},bumpmap:{bumpMap:{value:null},bumpMapTransform:{value:new ne},bumpScale:{value:1}},normalmap:{normalMap:{value:null},normalMapTransform:{value:new ne},normalScale:{value:new ee(1,1)}},displacementmap:{displacementMap:{value:null},displacementMapTransform:{value:new ne},displacementScale:{value:1},displacementBias:{value:0}},emissivemap:{emissiveMap:{value:null},emissiveMapTransform:{value:new ne}},metalnessmap:{metalnessMap:{value:null},metalnessMapTransform:{value:new ne}},roughnessmap:{roughnessMap:{value:null},roughnessMapTransform:{value:new ne}},gradientmap:{gradientMap:{value:null}},fog:{fogDensity:{value:25e-5},fogNear:{value:1},fogFar:{value:2e3},fogColor:{value:new se(16777215)}},lights:{ambientLightColor:{value:[]},lightProbe:{value:[]},sunLights:{value:[],properties:{direction:{},color:{}}},sunLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},sunShadowMatrix:{value:[]},sunShadowCascade:{value:[]},directionalLights:{value:[],properties:{direction:{},color:{}}},directionalLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},directionalShadowMatrix:{value:[]},spotLights:{value:[],properties:{color:{},position:{},direction:{},distance:{},coneCos:{},penumbraCos:{},decay:{}}},spotLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},spotLightMap:{value:[]},spotLightMatrix:{value:[]},pointLights:{value:[],properties:{color:{},position:{},decay:{},distance:{}}},pointLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{},shadowCameraNear:{},shadowCameraFar:{}}},pointShadowMatrix:{value:[]},hemisphereLights:{value:[],properties:{direction:{},skyColor:{},groundColor:{}}},rectAreaLights:{value:[],properties:{color:{},position:{},width:{},height:{}}},ltc_1:{value:null},ltc_2:{value:null},probesSH:{value:[]},probesMin:{value:[]},probesMax:{value:[]},probesResolution:{value:[]}},points:{diffuse:{value:new se(16777215)},opacity:{value:1},size:{value:1},scale:{value:1},map:{value:null},alphaMap:{value:null},alphaMapTransform:{value:new ne},alphaTest:{value:0},uvTransform:{value:new ne}},sprite:{diffuse:{value:new se(16777215)},opacity:{value:1},center:{value:new ee(.5,.5)},rotation:{value:0},map:{value:null},mapTransform:{value:new ne},alphaMap:{value:null},alphaMapTransform:{value:new ne},alphaTest:{value:0}}},Di={basic:{uniforms:kn([Lt.common,Lt.specularmap,Lt.envmap,Lt.aomap,Lt.lightmap,Lt.fog]),vertexShader:oe.meshbasic_vert,fragmentShader:oe.meshbasic_frag},lambert:{uniforms:kn([Lt.common,Lt.specularmap,Lt.envmap,Lt.aomap,Lt.lightmap,Lt.emissivemap,Lt.bumpmap,Lt.normalmap,Lt.displacementmap,Lt.fog,Lt.lights,{emissive:{value:new se(0)},envMapIntensity:{value:1}}]),vertexShader:oe.meshlambert_vert,fragmentShader:oe.meshlambert_frag},phong:{uniforms:kn([Lt.common,Lt.specularmap,Lt.envmap,Lt.aomap,Lt.lightmap,Lt.emissivemap,Lt.bumpmap,Lt.normalmap,Lt.displacementmap,Lt.fog,Lt.lights,{emissive:{value:new se(0)},specular:{value:new se(1118481)},shininess:{value:30},envMapIntensity:{value:1}}]),vertexShader:oe.meshphong_vert,fragmentShader:oe.meshphong_frag},standard:{uniforms:kn([Lt.common,Lt.envmap,Lt.aomap,Lt.lightmap,Lt.emissivemap,Lt.bumpmap,Lt.normalmap,Lt.displacementmap,Lt.roughnessmap,Lt.metalnessmap,Lt.fog,Lt.lights,{emissive:{value:new se(0)},roughness:{value:1},metalness:{value:0},envMapIntensity:{value:1}}]),vertexShader:oe.meshphysical_vert,fragmentShader:oe.meshphysical_frag},toon:{uniforms:kn([Lt.common,Lt.aomap,Lt.lightmap,Lt.emissivemap,Lt.bumpmap,Lt.normalmap,Lt.displacementmap,Lt.gradientmap,Lt.fog,Lt.lights,{emissive:{value:new se(0)}}]),vertexShader:oe.meshtoon_vert,fragmentShader:oe.meshtoon_frag},matcap:{uniforms:kn([Lt.common,Lt.bumpmap,Lt.normalmap,Lt.displacementmap,Lt.fog,{matcap:{value:null}}]),vertexShader:oe.meshmatcap_vert,fragmentShader:oe.meshmatcap_frag},points:{uniforms:kn([Lt.points,Lt.fog]),vertexShader:oe.points_vert,fragmentShader:oe.points_frag},dashed:{uniforms:kn([Lt.common,Lt.fog,{scale:{value:1},dashSize:{value:1},totalSize:{value:2}}]),vertexShader:oe.linedashed_vert,fragmentShader:oe.linedashed_frag},depth:{uniforms:kn([Lt.common,Lt.displacementmap]),vertexShader:oe.depth_vert,fragmentShader:oe.depth_frag},normal:{uniforms:kn([Lt.common,Lt.bumpmap,Lt.normalmap,Lt.displacementmap,{opacity:{value:1}}]),vertexShader:oe.meshnormal_vert,fragmentShader:oe.meshnormal_frag},sprite:{uniforms:kn([Lt.sprite,Lt.fog]),vertexShader:oe.sprite_vert,fragmentShader:oe.sprite_frag},background:{uniforms:{uvTransform:{value:new ne},t2D:{value:null},backgroundIntensity:{value:1}},vertexShader:oe.background_vert,fragmentShader:oe.background_frag},backgroundCube:{uniforms:{envMap:{value:null},backgroundBlurriness:{value:0},backgroundIntensity:{value:1},backgroundRotation:{value:new ne}},vertexShader:oe.backgroundCube_vert,fragmentShader:oe.backgroundCube_frag},cube:{uniforms:{tCube:{value:null},tFlip:{value:-1},opacity:{value:1}},vertexShader:oe.cube_vert,fragmentShader:oe.cube_frag},equirect:{uniforms:{tEquirect:{value:null}},vertexShader:oe.equirect_vert,fragmentShader:oe.equirect_frag},distance:{uniforms:kn([Lt.common,Lt.displacementmap,{referencePosition:{value:new W},nearDistance:{value:1},farDistance:{value:1e3}}]),vertexShader:oe.distance_vert,fragmentShader:oe.distance_frag},shadow:{uniforms:kn([Lt.lights,Lt.fog,{color:{value:new se(0)},opacity:{value:1}}]),vertexShader:oe.shadow_vert,fragmentShader:oe.shadow_frag}};Di.physical={uniforms:kn([Di.standard.uniforms,{clearcoat:{value:0},clearcoatMap:{value:null},clearcoatMapTransform:{value:new ne},clearcoatNormalMap:{value:null},clearcoatNormalMapTransform:{value:new ne},clearcoatNormalScale:{value:new ee(1,1)},clearcoatRoughness:{value:0},clearcoatRoughnessMap:{value:null},clearcoatRoughnessMapTransform:{value:new ne},diffuseRoughness:{value:0},diffuseRoughnessMap:{value:null},diffuseRoughnessMapTransform:{value:new ne},dispersion:{value:0},retroreflectivity:{value:0},iridescence:{value:0},iridescenceMap:{value:null},iridescenceMapTransform:{value:new ne},iridescenceIOR:{value:1.3},iridescenceThicknessMinimum:{value:100},iridescenceThicknessMaximum:{value:400},iridescenceThicknessMap:{value:null},iridescenceThicknessMapTransform:{value:new ne},sheen:{value:0},sheenColor:{value:new se(0)},sheenColorMap:{value:null},sheenColorMapTransform:{value:new ne},sheenRoughness:{value:1},sheenRoughnessMap:{value:null},sheenRoughnessMapTransform:{value:new ne},transmission:{value:0},transmissionMap:{value:null},transmissionMapTransform:{value:new ne},transmissionSamplerSize:{value:new ee},transmissionSamplerMap:{value:null},thickness:{value:0},thicknessMap:{value:null},thicknessMapTransform:{value:new ne},attenuationDistance:{value:0},attenuationColor:{value:new se(0)},specularColor:{value:new se(1,1,1)},specularColorMap:{value:null},specularColorMapTransform:{value:new ne},specularIntensity:{value:1},specularIntensityMap:{value:null},specularIntensityMapTransform:{value:new ne},anisotropyVector:{value:new ee},anisotropyMap:{value:null},anisotropyMapTransform:{value:new ne}}]),vertexShader:oe.meshphysical_vert,fragmentShader:oe.meshphysical_frag};const co={r:0,b:0,g:0},gS=new Pe,Vp=new ne;Vp.set(-1,0,0,0,1,0,0,0,1);function _S(i,t,e,n,s,r){const a=new se(0);let o=s===!0?0:1,l,c,h=null,u=0,f=null;function d(S){let C=S.isScene===!0?S.background:null;if(C&&C.isTexture){const b=S.backgroundBlurriness>0;C=t.get(C,b)}return C}function x(S){let C=!1;const b=d(S);b===null?m(a,o):b&&b.isColor&&(m(b,1),C=!0);const P=i.xr.getEnvironmentBlendMode();P==="additive"?e.buffers.color.setClear(0,0,0,1,r):P==="alpha-blend"&&e.buffers.color.setClear(0,0,0,0,r),(i.autoClear||C)&&(e.buffers.depth.setTest(!0),e.buffers.depth.setMask(!0),e.buffers.color.setMask(!0),i.clear(i.autoClearColor,i.autoClearDepth,i.autoClearStencil))}function v(S,C){const b=d(C);b&&b.isCubeTexture?(c===void 0&&(c=new ss(new Aa(1,1,1),new Hs({name:"BackgroundCubeMaterial",uniforms:Nr(Di.backgroundCube.uniforms),vertexShader:Di.backgroundCube.vertexShader,fragmentShader:Di.backgroundCube.fragmentShader,side:Vn,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),c.geometry.deleteAttribute("normal"),c.geometry.deleteAttribute("uv"),c.onBeforeRender=function(P,T,_){this.matrixWorld.copyPosition(_.matrixWorld)},Object.defineProperty(c.material,"envMap",{get:function(){return this.uniforms.envMap.value}}),n.update(c)),c.material.uniforms.envMap.value=b,c.material.uniforms.backgroundBlurriness.value=C.backgroundBlurriness,c.material.uniforms.backgroundIntensity.value=C.backgroundIntensity,c.material.uniforms.backgroundRotation.value.setFromMatrix4(gS.makeRotationFromEuler(C.backgroundRotation)).transpose(),b.isRenderTargetTexture===!1&&c.material.uniforms.backgroundRotation.value.premultiply(Vp),c.material.toneMapped=_e.getTransfer(b.colorSpace)!==Ce,(h!==b||u!==b.version||f!==i.toneMapping)&&(c.material.needsUpdate=!0,h=b,u=b.version,f=i.toneMapping),c.layers.enableAll(),S.unshift(c,c.geometry,c.material,0,0,null)):b&&b.isTexture&&(l===void 0&&(l=new ss(new Yo(2,2),new Hs({name:"BackgroundMaterial",uniforms:Nr(Di.background.uniforms),vertexShader:Di.background.vertexShader,fragmentShader:Di.background.fragmentShader,side:Bs,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),l.geometry.deleteAttribute("normal"),Object.defineProperty(l.material,"map",{get:function(){return this.uniforms.t2D.value}}),n.update(l)),l.material.uniforms.t2D.value=b,l.material.uniforms.backgroundIntensity.value=C.backgroundIntensity,l.material.toneMapped=_e.getTransfer(b.colorSpace)!==Ce,b.matrixAutoUpdate===!0&&b.updateMatrix(),l.material.uniforms.uvTransform.value.copy(b.matrix),(h!==b||u!==b.version||f!==i.toneMapping)&&(l.material.needsUpdate=!0,h=b,u=b.version,f=i.toneMapping),l.layers.enableAll(),S.unshift(l,l.geometry,l.material,0,0,null))}function m(S,C){S.getRGB(co,Op(i)),e.buffers.color.setClear(co.r,co.g,co.b,C,r)}function p(){c!==void 0&&(c.geometry.dispose(),c.material.dispose(),c=void 0),l!==void 0&&(l.geometry.dispose(),l.material.dispose(),l=void 0)}return{getClearColor:function(){return a},setClearColor:function(S,C=1){a.set(S),o=C,m(a,o)},getClearAlpha:function(){return o},setClearAlpha:function(S){o=S,m(a,o)},render:x,addToRenderList:v,dispose:p}}function xS(i,t){const e=i.getParameter(i.MAX_VERTEX_ATTRIBS),n={},s=f(null);let r=s,a=!1;function o(D,z,V,N,H){let K=!1;const k=u(D,N,V,z);r!==k&&(r=k,c(r.object)),K=d(D,N,V,H),K&&x(D,N,V,H),H!==null&&t.update(H,i.ELEMENT_ARRAY_BUFFER),(K||a)&&(a=!1,b(D,z,V,N),H!==null&&i.bindBuffer(i.ELEMENT_ARRAY_BUFFER,t.get(H).buffer))}function l(){return i.createVertexArray()}function c(D){return i.bindVertexArray(D)}function h(D){return i.deleteVertexArray(D)}function u(D,z,V,N){const H=N.wireframe===!0;let K=n[z.id];K===void 0&&(K={},n[z.id]=K);const k=D.isInstancedMesh===!0?D.id:0;let lt=K[k];lt===void 0&&(lt={},K[k]=lt);let Z=lt[V.id];Z===void 0&&(Z={},lt[V.id]=Z);let Q=Z[H];return Q===void 0&&(Q=f(l()),Z[H]=Q),Q}function f(D){const z=[],V=[],N=[];for(let H=0;H<e;H++)z[H]=0,V[H]=0,N[H]=0;return{geometry:null,program:null,wireframe:!1,newAttributes:z,enabledAttributes:V,attributeDivisors:N,object:D,attributes:{},index:null}}function d(D,z,V,N){const H=r.attributes,K=z.attributes;let k=0;const lt=V.getAttributes();for(const Z in lt)if(lt[Z].location>=0){const it=H[Z];let ut=K[Z];if(ut===void 0&&(Z==="instanceMatrix"&&D.instanceMatrix&&(ut=D.instanceMatrix),Z==="instanceColor"&&D.instanceColor&&(ut=D.instanceColor)),it===void 0||it.attribute!==ut||ut&&it.data!==ut.data)return!0;k++}return r.attributesNum!==k||r.index!==N}function x(D,z,V,N){const H={},K=z.attributes;let k=0;const lt=V.getAttributes();for(const Z in lt)if(lt[Z].location>=0){let it=K[Z];it===void 0&&(Z==="instanceMatrix"&&D.instanceMatrix&&(it=D.instanceMatrix),Z==="instanceColor"&&D.instanceColor&&(it=D.instanceColor));const ut={};ut.attribute=it,it&&it.data&&(ut.data=it.data),H[Z]=ut,k++}r.attributes=H,r.attributesNum=k,r.index=N}function v(){const D=r.newAttributes;for(let z=0,V=D.length;z<V;z++)D[z]=0}function m(D){p(D,0)}function p(D,z){const V=r.newAttributes,N=r.enabledAttributes,H=r.attributeDivisors;V[D]=1,N[D]===0&&(i.enableVertexAttribArray(D),N[D]=1),H[D]!==z&&(i.vertexAttribDivisor(D,z),H[D]=z)}function S(){const D=r.newAttributes,z=r.enabledAttributes;for(let V=0,N=z.length;V<N;V++)z[V]!==D[V]&&(i.disableVertexAttribArray(V),z[V]=0)}function C(D,z,V,N,H,K,k){k===!0?i.vertexAttribIPointer(D,z,V,H,K):i.vertexAttribPointer(D,z,V,N,H,K)}function b(D,z,V,N){v();const H=N.attributes,K=V.getAttributes(),k=z.defaultAttributeValues;for(const lt in K){const Z=K[lt];if(Z.location>=0){let Q=H[lt];if(Q===void 0&&(lt==="instanceMatrix"&&D.instanceMatrix&&(Q=D.instanceMatrix),lt==="instanceColor"&&D.instanceColor&&(Q=D.instanceColor)),Q!==void 0){const it=Q.normalized,ut=Q.itemSize,ht=t.get(Q);if(ht===void 0)continue;const j=ht.buffer,pt=ht.type,_t=ht.bytesPerElement,Tt=pt===i.INT||pt===i.UNSIGNED_INT||Q.gpuType===gh;if(Q.isInterleavedBufferAttribute){const St=Q.data,Gt=St.isInterleavedBuffer===!0?St.stride:St.itemSize,jt=Q.offset;if(St.isInstancedInterleavedBuffer||St.isInstancedBufferAttribute){for(let zt=0;zt<Z.locationSize;zt++)p(Z.location+zt,St.meshPerAttribute);D.isInstancedMesh!==!0&&N._maxInstanceCount===void 0&&(N._maxInstanceCount=St.meshPerAttribute*St.count)}else for(let zt=0;zt<Z.locationSize;zt++)m(Z.location+zt);i.bindBuffer(i.ARRAY_BUFFER,j);for(let zt=0;zt<Z.locationSize;zt++)C(Z.location+zt,ut/Z.locationSize,pt,it,Gt*_t,(jt+ut/Z.locationSize*zt)*_t,Tt)}else{if(Q.isInstancedBufferAttribute){for(let St=0;St<Z.locationSize;St++)p(Z.location+St,Q.meshPerAttribute);D.isInstancedMesh!==!0&&N._maxInstanceCount===void 0&&(N._maxInstanceCount=Q.meshPerAttribute*Q.count)}else for(let St=0;St<Z.locationSize;St++)m(Z.location+St);i.bindBuffer(i.ARRAY_BUFFER,j);for(let St=0;St<Z.locationSize;St++)C(Z.location+St,ut/Z.locationSize,pt,it,ut*_t,ut/Z.locationSize*St*_t,Tt)}}else if(k!==void 0){const it=k[lt];if(it!==void 0)switch(it.length){case 2:i.vertexAttrib2fv(Z.location,it);break;case 3:i.vertexAttrib3fv(Z.location,it);break;case 4:i.vertexAttrib4fv(Z.location,it);break;default:i.vertexAttrib1fv(Z.location,it)}}}}S()}function P(){B();for(const D in n){const z=n[D];for(const V in z){const N=z[V];for(const H in N){const K=N[H];for(const k in K)h(K[k].object),delete K[k];delete N[H]}}delete n[D]}}function T(D){if(n[D.id]===void 0)return;const z=n[D.id];for(const V in z){const N=z[V];for(const H in N){const K=N[H];for(const k in K)h(K[k].object),delete K[k];delete N[H]}}delete n[D.id]}function _(D){for(const z in n){const V=n[z];for(const N in V){const H=V[N];if(H[D.id]===void 0)continue;const K=H[D.id];for(const k in K)h(K[k].object),delete K[k];delete H[D.id]}}}function w(D){for(const z in n){const V=n[z],N=D.isInstancedMesh===!0?D.id:0,H=V[N];if(H!==void 0){for(const K in H){const k=H[K];for(const lt in k)h(k[lt].object),delete k[lt];delete H[K]}delete V[N],Object.keys(V).length===0&&delete n[z]}}}function B(){I(),a=!0,r!==s&&(r=s,c(r.object))}function I(){s.geometry=null,s.program=null,s.wireframe=!1}return{setup:o,reset:B,resetDefaultState:I,dispose:P,releaseStatesOfGeometry:T,releaseStatesOfObject:w,releaseStatesOfProgram:_,initAttributes:v,enableAttribute:m,disableUnusedAttributes:S}}function vS(i,t,e){let n;function s(l){n=l}function r(l,c){i.drawArrays(n,l,c),e.update(c,n,1)}function a(l,c,h){h!==0&&(i.drawArraysInstanced(n,l,c,h),e.update(c,n,h))}function o(l,c,h){if(h===0)return;t.get("WEBGL_multi_draw").multiDrawArraysWEBGL(n,l,0,c,0,h);let f=0;for(let d=0;d<h;d++)f+=c[d];e.update(f,n,1)}this.setMode=s,this.render=r,this.renderInstances=a,this.renderMultiDraw=o}function MS(i,t,e,n){let s;function r(){if(s!==void 0)return s;if(t.has("EXT_texture_filter_anisotropic")===!0){const _=t.get("EXT_texture_filter_anisotropic");s=i.getParameter(_.MAX_TEXTURE_MAX_ANISOTROPY_EXT)}else s=0;return s}function a(_){return!(_!==Ni&&n.convert(_)!==i.getParameter(i.IMPLEMENTATION_COLOR_READ_FORMAT))}function o(_){const w=_===Oi&&(t.has("EXT_color_buffer_half_float")||t.has("EXT_color_buffer_float"));return!(_!==jn&&_!==Mi&&!w&&n.convert(_)!==i.getParameter(i.IMPLEMENTATION_COLOR_READ_TYPE))}function l(_){if(_==="highp"){if(i.getShaderPrecisionFormat(i.VERTEX_SHADER,i.HIGH_FLOAT).precision>0&&i.getShaderPrecisionFormat(i.FRAGMENT_SHADER,i.HIGH_FLOAT).precision>0)return"highp";_="mediump"}return _==="mediump"&&i.getShaderPrecisionFormat(i.VERTEX_SHADER,i.MEDIUM_FLOAT).precision>0&&i.getShaderPrecisionFormat(i.FRAGMENT_SHADER,i.MEDIUM_FLOAT).precision>0?"mediump":"lowp"}let c=e.precision!==void 0?e.precision:"highp";const h=l(c);h!==c&&(Kt("WebGLRenderer:",c,"not supported, using",h,"instead."),c=h);const u=e.reversedDepthBuffer===!0&&t.has("EXT_clip_control"),f=e.logarithmicDepthBuffer===!0&&u===!1;e.reversedDepthBuffer===!0&&u===!1&&Kt("WebGLRenderer: Unable to use reversed depth buffer due to missing EXT_clip_control extension. Fallback to default depth buffer."),e.logarithmicDepthBuffer===!0&&u===!0&&Kt("WebGLRenderer: Logarithmic depth buffer is ignored when reversed depth buffer is enabled.");const d=i.getParameter(i.MAX_TEXTURE_IMAGE_UNITS),x=i.getParameter(i.MAX_VERTEX_TEXTURE_IMAGE_UNITS),v=i.getParameter(i.MAX_TEXTURE_SIZE),m=i.getParameter(i.MAX_CUBE_MAP_TEXTURE_SIZE),p=i.getParameter(i.MAX_VERTEX_ATTRIBS),S=i.getParameter(i.MAX_VERTEX_UNIFORM_VECTORS),C=i.getParameter(i.MAX_VARYING_VECTORS),b=i.getParameter(i.MAX_FRAGMENT_UNIFORM_VECTORS),P=i.getParameter(i.MAX_SAMPLES),T=i.getParameter(i.SAMPLES);return{isWebGL2:!0,getMaxAnisotropy:r,getMaxPrecision:l,textureFormatReadable:a,textureTypeReadable:o,precision:c,logarithmicDepthBuffer:f,reversedDepthBuffer:u,maxTextures:d,maxVertexTextures:x,maxTextureSize:v,maxCubemapSize:m,maxAttributes:p,maxVertexUniforms:S,maxVaryings:C,maxFragmentUniforms:b,maxSamples:P,samples:T}}function SS(i){const t=this;let e=null,n=0,s=!1,r=!1;const a=new Zi,o=new ne,l={value:null,needsUpdate:!1};this.uniform=l,this.numPlanes=0,this.numIntersection=0,this.init=function(u,f){const d=u.length!==0||f||n!==0||s;return s=f,n=u.length,d},this.beginShadows=function(){r=!0,h(null)},this.endShadows=function(){r=!1},this.setGlobalState=function(u,f){e=h(u,f,0)},this.setState=function(u,f,d){const x=u.clippingPlanes,v=u.clipIntersection,m=u.clipShadows,p=i.get(u);if(!s||x===null||x.length===0||r&&!m)r?h(null):c();else{const S=r?0:n,C=S*4;let b=p.clippingState||null;l.value=b,b=h(x,f,C,d);for(let P=0;P!==C;++P)b[P]=e[P];p.clippingState=b,this.numIntersection=v?this.numPlanes:0,this.numPlanes+=S}};function c(){l.value!==e&&(l.value=e,l.needsUpdate=n>0),t.numPlanes=n,t.numIntersection=0}function h(u,f,d,x){const v=u!==null?u.length:0;let m=null;if(v!==0){if(m=l.value,x!==!0||m===null){const p=d+v*4,S=f.matrixWorldInverse;o.getNormalMatrix(S),(m===null||m.length<p)&&(m=new Float32Array(p));for(let C=0,b=d;C!==v;++C,b+=4)a.copy(u[C]).applyMatrix4(S,o),a.normal.toArray(m,b),m[b+3]=a.constant}l.value=m,l.needsUpdate=!0}return t.numPlanes=v,t.numIntersection=0,m}}class Ph extends Ii{constructor(t=1,e={}){super(t,t,e),this.isWebGLCubeRenderTarget=!0;const n={width:t,height:t,depth:1},s=[n,n,n,n,n,n];this.texture=new Ip(s),this._setTextureOptions(e),this.texture.isRenderTargetTexture=!0}fromEquirectangularTexture(t,e){this.texture.type=e.type,this.texture.colorSpace=e.colorSpace,this.texture.generateMipmaps=e.generateMipmaps,this.texture.minFilter=e.minFilter,this.texture.magFilter=e.magFilter;const n={uniforms:{tEquirect:{value:null}},vertexShader:`

				varying vec3 vWorldDirection;

				vec3 transformDirection( in vec3 dir, in mat4 matrix ) {

					return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );

				}

				void main() {

					vWorldDirection = transformDirection( position, modelMatrix );

					#include <begin_vertex>
					#include <project_vertex>

				}
			`,fragmentShader:`

				uniform sampler2D tEquirect;

				varying vec3 vWorldDirection;

				#include <common>

				void main() {

					vec3 direction = normalize( vWorldDirection );

					vec2 sampleUV = equirectUv( direction );

					gl_FragColor = texture2D( tEquirect, sampleUV );

				}
			`},s=new Aa(5,5,5),r=new Hs({name:"CubemapFromEquirect",uniforms:Nr(n.uniforms),vertexShader:n.vertexShader,fragmentShader:n.fragmentShader,side:Vn,blending:Er});r.uniforms.tEquirect.value=e;const a=new ss(s,r),o=e.minFilter;return e.minFilter===Ss&&(e.minFilter=Gn),new Jc(1,10,this).update(t,a),e.minFilter=o,a.geometry.dispose(),a.material.dispose(),this}clear(t,e=!0,n=!0,s=!0){const r=t.getRenderTarget();for(let a=0;a<6;a++)t.setRenderTarget(this,a),t.clear(e,n,s);t.setRenderTarget(r)}}const kf=256,yS=3,ES=20,Wp=256,Xp=16,bS=3,wS=new W,TS=new se;class ko{constructor(t){this._renderer=t,this._cubeSize=0,this._sourceTarget=null,this._cubeCamera=new Jc(1,10,null),this._boxMesh=new ss(new Aa(5,5,5),null),this._cubemapMaterial=null,this._equirectMaterial=null,this._blurMaterial=null,this._ggxMaterial=null,this._integrationMaterial=null}fromScene(t,e=0,n=.1,s=100,r={}){const{size:a=256,position:o=wS}=r,l=this._renderer;this._setSize(a);const c=this._allocateTarget(),h=this._getSourceTarget(!0);e>0&&(h.texture.mipmapsAutoUpdate=!1);const u=l.autoClear,f=l.autoClearColor,d=l.autoClearDepth,x=l.autoClearStencil,v=t.background;l.autoClear=!0,l.autoClearColor=!0,l.autoClearDepth=!0,l.autoClearStencil=!0,v===null&&(t.background=l.getClearColor(TS));const m=new Jc(n,s,h);return m.position.copy(o),m.update(l,t),l.autoClear=u,l.autoClearColor=f,l.autoClearDepth=d,l.autoClearStencil=x,t.background=v,e>0&&(h.texture.mipmapsAutoUpdate=!0,this._blur(c,e)),this._applyPMREM(c),c}fromEquirectangular(t,e=null){return this._fromTexture(t,e)}fromCubemap(t,e=null){return this._fromTexture(t,e)}compileCubemapShader(){this._cubemapMaterial===null&&(this._cubemapMaterial=Hf(),this._compileMaterial(this._cubemapMaterial))}compileEquirectangularShader(){this._equirectMaterial===null&&(this._equirectMaterial=zf(),this._compileMaterial(this._equirectMaterial))}dispose(){this._sourceTarget!==null&&this._sourceTarget.dispose(),this._cubemapMaterial!==null&&this._cubemapMaterial.dispose(),this._equirectMaterial!==null&&this._equirectMaterial.dispose(),this._blurMaterial!==null&&this._blurMaterial.dispose(),this._ggxMaterial!==null&&this._ggxMaterial.dispose(),this._integrationMaterial!==null&&this._integrationMaterial.dispose(),this._boxMesh.geometry.dispose()}static lodToRoughness(t,e){return e>0?1-Math.sqrt(1-t/e):0}_setSize(t){this._cubeSize=Math.max(kf,Y0(t))}_fromTexture(t,e){t.mapping===Pr||t.mapping===ya?this._setSize(t.image.length===0?kf:t.image[0].width||t.image[0].image.width):this._setSize(t.image.width/4);const n=e||this._allocateTarget();return this._textureToCubemap(t),this._applyPMREM(n),n}_allocateTarget(){const t=this._cubeSize,e=Bf(t,!1,!1),n=Math.log2(t)-yS;for(let s=0;s<=n;s++)e.texture.mipmaps.push({width:t>>s,height:t>>s});return e.texture.name="PMREM",e.texture.isPMREMTexture=!0,e}_getSourceTarget(t=!1){const e=this._cubeSize,n=this._sourceTarget;return(n===null||n.width!==e||t&&n.depthBuffer===!1)&&(n!==null&&n.dispose(),this._sourceTarget=Bf(e,!0,t)),this._sourceTarget}_compileMaterial(t){this._boxMesh.material=t,this._renderer.compile(this._boxMesh,this._cubeCamera.children[0])}_renderCube(t,e,n){const s=this._boxMesh,r=this._cubeCamera;s.material=n,r.renderTarget=t,r.activeMipmapLevel=e;const a=t.width>>e;t.viewport.set(0,0,a,a),r.update(this._renderer,s),t.viewport.set(0,0,t.width,t.height)}_textureToCubemap(t){let e;t.mapping===Pr||t.mapping===ya?(this._cubemapMaterial===null&&(this._cubemapMaterial=Hf()),e=this._cubemapMaterial,e.uniforms.flipEnvMap.value=t.isRenderTargetTexture===!1?-1:1):(this._equirectMaterial===null&&(this._equirectMaterial=zf()),e=this._equirectMaterial),e.uniforms.envMap.value=t,this._renderCube(this._getSourceTarget(),0,e)}_applyPMREM(t){this._ggxMaterial===null&&(this._ggxMaterial=AS(),this._integrationMaterial=RS());const e=this._cubeSize,n=t.texture.mipmaps.length-1,s=this._ggxMaterial.uniforms;s.envMap.value=this._sourceTarget.texture;const r=this._integrationMaterial.uniforms;r.envMap.value=this._sourceTarget.texture,r.sourceLod.value=Math.log2(e/Xp);for(let a=0;a<=n;a++){const o=ko.lodToRoughness(a,n);if(a>n-bS)r.roughness.value=o,this._renderCube(t,a,this._integrationMaterial);else{const l=o>0?Math.log2(e)+.5*Math.log2(6/(Wp*Math.pow(o,4)))+.5:0;s.roughness.value=o,s.lodBias.value=l,this._renderCube(t,a,this._ggxMaterial)}}}_blur(t,e){this._blurMaterial===null&&(this._blurMaterial=CS());const n=this._blurMaterial,s=n.uniforms,r=this._sourceTarget;s.sigma.value=Math.min(e,Math.PI)/Math.SQRT2,s.envMap.value=r.texture,this._renderCube(t,0,n),s.envMap.value=t.texture,this._renderCube(r,0,n)}}function Bf(i,t,e){return new Ph(i,{minFilter:Ss,generateMipmaps:t,type:Oi,colorSpace:Do,depthBuffer:e})}function Ra(i,t,e){return new Hs({name:i,uniforms:t,vertexShader:oe.cube_vert,fragmentShader:e,side:Vn,blending:Er,depthTest:!1,depthWrite:!1})}function AS(){return Ra("PMREMGGXConvolution",{envMap:{value:null},roughness:{value:0},lodBias:{value:0}},`

		#define GGX_SAMPLES ${Wp}u

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float lodBias;

		#include <common>

		// Van der Corput radical inverse
		float radicalInverse_VdC( uint bits ) {

			bits = ( bits << 16u ) | ( bits >> 16u );
			bits = ( ( bits & 0x55555555u ) << 1u ) | ( ( bits & 0xAAAAAAAAu ) >> 1u );
			bits = ( ( bits & 0x33333333u ) << 2u ) | ( ( bits & 0xCCCCCCCCu ) >> 2u );
			bits = ( ( bits & 0x0F0F0F0Fu ) << 4u ) | ( ( bits & 0xF0F0F0F0u ) >> 4u );
			bits = ( ( bits & 0x00FF00FFu ) << 8u ) | ( ( bits & 0xFF00FF00u ) >> 8u );
			return float( bits ) * 2.3283064365386963e-10; // / 0x100000000

		}

		// Hammersley sequence
		vec2 hammersley( uint i, uint N ) {

			return vec2( float( i ) / float( N ), radicalInverse_VdC( i ) );

		}

		void main() {

			vec3 N = normalize( vWorldDirection );

			// For very low roughness, just sample the environment directly
			if ( roughness < 0.001 ) {

				gl_FragColor = vec4( textureLod( envMap, N, 0.0 ).rgb, 1.0 );
				return;

			}

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			// Tangent space basis for VNDF sampling
			vec3 up = abs( N.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, N ) );
			vec3 bitangent = cross( N, tangent );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			for ( uint i = 0u; i < GGX_SAMPLES; i ++ ) {

				vec2 Xi = hammersley( i, GGX_SAMPLES );

				// With V = N, sample the reflected direction directly.
				float invQ = 1.0 / ( 1.0 - Xi.x + alpha2 * Xi.x );
				float NdotL = ( 1.0 - Xi.x - alpha2 * Xi.x ) * invQ;

				if ( NdotL > 0.0 ) {

					float phi = 2.0 * PI * Xi.y;
					float sinTheta = 2.0 * alpha * sqrt( Xi.x * ( 1.0 - Xi.x ) ) * invQ;
					vec3 L = N * NdotL + ( tangent * cos( phi ) + bitangent * sin( phi ) ) * sinTheta;

					// Match the source mip to the sample's solid angle. The terms
					// independent of the sample are precomputed in lodBias.
					float d = alpha2 * invQ;
					float lod = max( log2( d ) + lodBias, 0.0 );

					// Weight by NdotL for the split-sum approximation
					prefilteredColor += textureLod( envMap, L, lod ).rgb * NdotL;
					totalWeight += NdotL;

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function RS(){return Ra("PMREMGGXIntegration",{envMap:{value:null},roughness:{value:0},sourceLod:{value:0},sourceSize:{value:Xp}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float sourceLod;
		uniform int sourceSize;

		void main() {

			vec3 N = normalize( vWorldDirection );

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			float texelSize = 2.0 / float( sourceSize );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			// Pair opposite texels: only the one in N's hemisphere contributes.
			for ( int face = 0; face < 3; face ++ ) {

				for ( int y = 0; y < sourceSize; y ++ ) {

					for ( int x = 0; x < sourceSize; x ++ ) {

						vec2 uv = ( vec2( x, y ) + 0.5 ) * texelSize - 1.0;
						vec3 texelDirection = face == 0 ? vec3( 1.0, uv ) : ( face == 1 ? vec3( uv.x, 1.0, uv.y ) : vec3( uv, 1.0 ) );

						float invDistance = inversesqrt( 1.0 + dot( uv, uv ) );
						float NdotL = dot( N, texelDirection );
						texelDirection *= NdotL < 0.0 ? - 1.0 : 1.0;
						NdotL = abs( NdotL ) * invDistance;

						// With V = N, NdotH squared is ( 1 + NdotL ) / 2. Common factors
						// in the GGX distribution and texel solid angle cancel when normalized.
						float d = 1.0 + alpha2 + ( alpha2 - 1.0 ) * NdotL;
						float weight = NdotL * invDistance * invDistance * invDistance / ( d * d );

						prefilteredColor += textureLod( envMap, texelDirection, sourceLod ).rgb * weight;
						totalWeight += weight;

					}

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function CS(){return Ra("PMREMSphericalGaussianBlur",{envMap:{value:null},sigma:{value:0}},`

		#define SAMPLES ${ES}
		#define GOLDEN_ANGLE 2.39996322973

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float sigma;

		#include <common>

		void main() {

			vec3 outputDirection = normalize( vWorldDirection );

			vec3 up = abs( outputDirection.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, outputDirection ) );
			vec3 bitangent = cross( outputDirection, tangent );

			// Truncate the kernel at three standard deviations or at the antipode.
			float thetaMax = min( 3.0 * sigma, PI );
			float truncation = 1.0 - exp( - 0.5 * thetaMax * thetaMax / ( sigma * sigma ) );

			vec3 accumColor = vec3( 0.0 );
			float accumWeight = 0.0;

			for ( int i = 0; i < SAMPLES; i ++ ) {

				// Stratified inverse-CDF sampling of the Gaussian, placed on a golden-angle spiral.
				float stratum = ( float( i ) + 0.5 ) / float( SAMPLES );
				float theta = sigma * sqrt( - 2.0 * log( 1.0 - stratum * truncation ) );
				float phi = float( i ) * GOLDEN_ANGLE;

				vec3 offset = cos( phi ) * tangent + sin( phi ) * bitangent;
				vec3 sampleDirection = cos( theta ) * outputDirection + sin( theta ) * offset;

				// Correct the planar sample density to solid angle.
				float weight = sin( theta ) / theta;

				accumColor += weight * textureLod( envMap, sampleDirection, 0.0 ).rgb;
				accumWeight += weight;

			}

			gl_FragColor = vec4( accumColor / accumWeight, 1.0 );

		}
	`)}function zf(){return Ra("PMREMEquirectangularToCubemap",{envMap:{value:null}},`

		varying vec3 vWorldDirection;

		uniform sampler2D envMap;

		#include <common>

		void main() {

			// Average four subpixel samples to preserve small, bright features.
			vec3 direction = normalize( vWorldDirection );
			vec3 dx = dFdx( direction ) * 0.25;
			vec3 dy = dFdy( direction ) * 0.25;

			vec3 color = textureLod( envMap, equirectUv( normalize( direction - dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction - dx + dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx + dy ) ), 0.0 ).rgb;
			gl_FragColor = vec4( color * 0.25, 1.0 );

		}
	`)}function Hf(){return Ra("PMREMCubemapToCubemap",{envMap:{value:null},flipEnvMap:{value:-1}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float flipEnvMap;

		void main() {

			gl_FragColor = vec4( textureCube( envMap, vec3( flipEnvMap * vWorldDirection.x, vWorldDirection.yz ) ).rgb, 1.0 );

		}
	`)}function PS(i){let t=new WeakMap,e=new WeakMap,n=null;function s(f,d=!1){return f==null?null:d?a(f):r(f)}function r(f){if(f&&f.isTexture){const d=f.mapping;if(d===Ml||d===Sl)if(t.has(f)){const x=t.get(f).texture;return o(x,f.mapping)}else{const x=f.image;if(x&&x.height>0){const v=new Ph(x.height);return v.fromEquirectangularTexture(i,f),t.set(f,v),f.addEventListener("dispose",c),o(v.texture,f.mapping)}else return null}}return f}function a(f){if(f&&f.isTexture&&f.isPMREMTexture!==!0){const d=f.mapping,x=d===Ml||d===Sl,v=d===Pr||d===ya;if(x||v){let m=e.get(f);const p=m!==void 0?m.texture.pmremVersion:0;if(f.isRenderTargetTexture&&f.pmremVersion!==p)return n===null&&(n=new ko(i)),m=x?n.fromEquirectangular(f,m):n.fromCubemap(f,m),m.texture.pmremVersion=f.pmremVersion,e.set(f,m),m.texture;if(m!==void 0)return m.texture;{const S=f.image;return x&&S&&S.height>0||v&&S&&l(S)?(n===null&&(n=new ko(i)),m=x?n.fromEquirectangular(f):n.fromCubemap(f),m.texture.pmremVersion=f.pmremVersion,e.set(f,m),f.addEventListener("dispose",h),m.texture):null}}}return f}function o(f,d){return d===Ml?f.mapping=Pr:d===Sl&&(f.mapping=ya),f}function l(f){let d=0;const x=6;for(let v=0;v<x;v++)f[v]!==void 0&&d++;return d===x}function c(f){const d=f.target;d.removeEventListener("dispose",c);const x=t.get(d);x!==void 0&&(t.delete(d),x.dispose())}function h(f){const d=f.target;d.removeEventListener("dispose",h);const x=e.get(d);x!==void 0&&(e.delete(d),x.dispose())}function u(){t=new WeakMap,e=new WeakMap,n!==null&&(n.dispose(),n=null)}return{get:s,dispose:u}}function LS(i){const t={};function e(n){if(t[n]!==void 0)return t[n];const s=i.getExtension(n);return t[n]=s,s}return{has:function(n){return e(n)!==null},init:function(){e("EXT_color_buffer_float"),e("WEBGL_clip_cull_distance"),e("OES_texture_float_linear"),e("EXT_color_buffer_half_float"),e("WEBGL_multisampled_render_to_texture"),e("WEBGL_render_shared_exponent")},get:function(n){const s=e(n);return s===null&&Eo("WebGLRenderer: "+n+" extension not supported."),s}}}function DS(i,t,e,n){const s={},r=new WeakMap,a=new FinalizationRegistry(x=>delete s[x]);function o(x){l(x.target)}function l(x){x.index!==null&&t.remove(x.index);for(const m in x.attributes)t.remove(x.attributes[m]);x.removeEventListener("dispose",o),delete s[x.id],a.unregister(x);const v=r.get(x);v&&(t.remove(v),r.delete(x)),n.releaseStatesOfGeometry(x),x.isInstancedBufferGeometry===!0&&delete x._maxInstanceCount,e.memory.geometries--}function c(x,v){return s[v.id]!==void 0||(v.addEventListener("dispose",o),s[v.id]=new WeakRef(v),a.register(v,v.id,v),e.memory.geometries++),v}function h(x){const v=x.attributes;for(const m in v)t.update(v[m],i.ARRAY_BUFFER)}function u(x){const v=x.index,m=x.attributes.position;let p=0;if(m===void 0)return;const S=v!==null?v.array.length:m.array.length/3-1,C=m.count>=65535?Pp:Cp,b=new C(Math.ceil(S/3)*6,1),P=b.array;if(v!==null){const _=v.array;p=v.version;for(let w=0,B=0;w<S;w+=3){const I=_[w+0],D=_[w+1],z=_[w+2];P[B++]=I,P[B++]=D,P[B++]=D,P[B++]=z,P[B++]=z,P[B++]=I}}else{p=m.version;for(let _=0,w=0;_<S;_+=3){const B=_+0,I=_+1,D=_+2;P[w++]=B,P[w++]=I,P[w++]=I,P[w++]=D,P[w++]=D,P[w++]=B}}b.version=p;const T=r.get(x);T&&t.remove(T),r.set(x,b)}function f(x){const v=r.get(x);if(v){const m=x.index;m!==null&&v.version<m.version&&u(x)}else u(x);return r.get(x)}function d(){for(const x in s){const v=s[x].deref();v!==void 0&&l(v)}}return{get:c,update:h,getWireframeAttribute:f,dispose:d}}function NS(i,t,e){let n;function s(u){n=u}let r,a;function o(u){r=u.type,a=u.bytesPerElement}function l(u,f){i.drawElements(n,f,r,u*a),e.update(f,n,1)}function c(u,f,d){d!==0&&(i.drawElementsInstanced(n,f,r,u*a,d),e.update(f,n,d))}function h(u,f,d){if(d===0)return;t.get("WEBGL_multi_draw").multiDrawElementsWEBGL(n,f,0,r,u,0,d);let v=0;for(let m=0;m<d;m++)v+=f[m];e.update(v,n,1)}this.setMode=s,this.setIndex=o,this.render=l,this.renderInstances=c,this.renderMultiDraw=h}function IS(i){const t={geometries:0,textures:0},e={frame:0,calls:0,triangles:0,points:0,lines:0};function n(r,a,o){switch(e.calls++,a){case i.TRIANGLES:e.triangles+=o*(r/3);break;case i.LINES:e.lines+=o*(r/2);break;case i.LINE_STRIP:e.lines+=o*(r-1);break;case i.LINE_LOOP:e.lines+=o*r;break;case i.POINTS:e.points+=o*r;break;default:Ee("WebGLInfo: Unknown draw mode:",a);break}}function s(){e.calls=0,e.triangles=0,e.points=0,e.lines=0}return{memory:t,render:e,programs:null,autoReset:!0,reset:s,update:n}}function US(i,t,e){const n=new WeakMap,s=new je;function r(a,o,l){const c=a.morphTargetInfluences,h=o.morphAttributes.position||o.morphAttributes.normal||o.morphAttributes.color,u=h!==void 0?h.length:0;let f=n.get(o);if(f===void 0||f.count!==u){let I=function(){w.dispose(),n.delete(o),o.removeEventListener("dispose",I)};var d=I;f!==void 0&&f.texture.dispose();const x=o.morphAttributes.position!==void 0,v=o.morphAttributes.normal!==void 0,m=o.morphAttributes.color!==void 0,p=o.morphAttributes.position||[],S=o.morphAttributes.normal||[],C=o.morphAttributes.color||[];let b=0;x===!0&&(b=1),v===!0&&(b=2),m===!0&&(b=3);let P=o.attributes.position.count*b,T=1;P>t.maxTextureSize&&(T=Math.ceil(P/t.maxTextureSize),P=t.maxTextureSize);const _=new Float32Array(P*T*4*u),w=new Tp(_,P,T,u);w.type=Mi,w.needsUpdate=!0;const B=b*4;for(let D=0;D<u;D++){const z=p[D],V=S[D],N=C[D],H=P*T*4*D;for(let K=0;K<z.count;K++){const k=K*B;x===!0&&(s.fromBufferAttribute(z,K),_[H+k+0]=s.x,_[H+k+1]=s.y,_[H+k+2]=s.z,_[H+k+3]=0),v===!0&&(s.fromBufferAttribute(V,K),_[H+k+4]=s.x,_[H+k+5]=s.y,_[H+k+6]=s.z,_[H+k+7]=0),m===!0&&(s.fromBufferAttribute(N,K),_[H+k+8]=s.x,_[H+k+9]=s.y,_[H+k+10]=s.z,_[H+k+11]=N.itemSize===4?s.w:1)}}f={count:u,texture:w,size:new ee(P,T)},n.set(o,f),o.addEventListener("dispose",I)}if(a.isInstancedMesh===!0&&a.morphTexture!==null)l.getUniforms().setValue(i,"morphTexture",a.morphTexture,e);else{let x=0;for(let m=0;m<c.length;m++)x+=c[m];const v=o.morphTargetsRelative?1:1-x;l.getUniforms().setValue(i,"morphTargetBaseInfluence",v),l.getUniforms().setValue(i,"morphTargetInfluences",c)}l.getUniforms().setValue(i,"morphTargetsTexture",f.texture,e),l.getUniforms().setValue(i,"morphTargetsTextureSize",f.size)}return{update:r}}function FS(i,t,e,n,s){let r=new WeakMap;function a(c){const h=s.render.frame,u=c.geometry,f=t.get(c,u);if(r.get(f)!==h&&(t.update(f),r.set(f,h)),c.isInstancedMesh&&(c.hasEventListener("dispose",l)===!1&&c.addEventListener("dispose",l),r.get(c)!==h&&(e.update(c.instanceMatrix,i.ARRAY_BUFFER),c.instanceColor!==null&&e.update(c.instanceColor,i.ARRAY_BUFFER),r.set(c,h))),c.isSkinnedMesh){const d=c.skeleton;r.get(d)!==h&&(d.update(),r.set(d,h))}return f}function o(){r=new WeakMap}function l(c){const h=c.target;h.removeEventListener("dispose",l),n.releaseStatesOfObject(h),e.remove(h.instanceMatrix),h.instanceColor!==null&&e.remove(h.instanceColor)}return{update:a,dispose:o}}const OS={[lp]:"LINEAR_TONE_MAPPING",[cp]:"REINHARD_TONE_MAPPING",[hp]:"CINEON_TONE_MAPPING",[up]:"ACES_FILMIC_TONE_MAPPING",[dp]:"AGX_TONE_MAPPING",[pp]:"NEUTRAL_TONE_MAPPING",[fp]:"CUSTOM_TONE_MAPPING"};function kS(i,t,e,n,s,r){const a=new Ii(t,e,{type:i,depthBuffer:s,stencilBuffer:r,samples:n?4:0,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,resolveDepthBuffer:!1,resolveStencilBuffer:!1});let o=null,l=null,c=null;const h=new li;h.setAttribute("position",new wn([-1,3,0,-1,-1,0,3,-1,0],3)),h.setAttribute("uv",new wn([0,2,0,0,2,0],2));const u=new Tx({uniforms:{tDiffuse:{value:null}},vertexShader:`
			precision highp float;

			uniform mat4 modelViewMatrix;
			uniform mat4 projectionMatrix;

			attribute vec3 position;
			attribute vec2 uv;

			varying vec2 vUv;

			void main() {
				vUv = uv;
				gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
			}`,fragmentShader:`
			precision highp float;

			uniform sampler2D tDiffuse;

			varying vec2 vUv;

			#include <tonemapping_pars_fragment>
			#include <colorspace_pars_fragment>

			void main() {
				gl_FragColor = texture2D( tDiffuse, vUv );

				#ifdef LINEAR_TONE_MAPPING
					gl_FragColor.rgb = LinearToneMapping( gl_FragColor.rgb );
				#elif defined( REINHARD_TONE_MAPPING )
					gl_FragColor.rgb = ReinhardToneMapping( gl_FragColor.rgb );
				#elif defined( CINEON_TONE_MAPPING )
					gl_FragColor.rgb = CineonToneMapping( gl_FragColor.rgb );
				#elif defined( ACES_FILMIC_TONE_MAPPING )
					gl_FragColor.rgb = ACESFilmicToneMapping( gl_FragColor.rgb );
				#elif defined( AGX_TONE_MAPPING )
					gl_FragColor.rgb = AgXToneMapping( gl_FragColor.rgb );
				#elif defined( NEUTRAL_TONE_MAPPING )
					gl_FragColor.rgb = NeutralToneMapping( gl_FragColor.rgb );
				#elif defined( CUSTOM_TONE_MAPPING )
					gl_FragColor.rgb = CustomToneMapping( gl_FragColor.rgb );
				#endif

				#ifdef SRGB_TRANSFER
					gl_FragColor = sRGBTransferOETF( gl_FragColor );
				#endif
			}`,depthTest:!1,depthWrite:!1}),f=new ss(h,u),d=new Hp(-1,1,1,-1,0,1);let x=null,v=null,m=!1,p,S=null,C=[],b=!1;this.setSize=function(P,T){a.setSize(P,T),o!==null&&o.setSize(P,T),l!==null&&l.setSize(P,T);for(let _=0;_<C.length;_++){const w=C[_];w.setSize&&w.setSize(P,T)}},this.setEffects=function(P){C=P,b=C.length>0&&C[0].isRenderPass===!0;const T=a.width,_=a.height;C.length>0&&o===null&&(o=new Ii(T,_,{type:Oi,depthBuffer:!1,stencilBuffer:!1}),l=new Ii(T,_,{type:Oi,depthBuffer:!1,stencilBuffer:!1}));const w=s===!0&&C.some(B=>B.needsDepthTexture===!0);w!==(a.depthTexture!==null)&&(w===!0&&c===null&&(c=new Dr(T,_),r===!0&&(c.format=ys,c.type=Lr)),a.dispose(),a.depthTexture=w?c:null,a.resolveDepthBuffer=w,a.storeMultisampledDepthBuffer=w);for(let B=0;B<C.length;B++){const I=C[B];I.setSize&&I.setSize(T,_),w&&I.needsDepthTexture===!0&&I.setDepthTexture&&I.setDepthTexture(c)}},this.begin=function(P,T){if(m||P.toneMapping===ns&&C.length===0)return!1;if(S=T,T!==null){const _=T.width,w=T.height;(a.width!==_||a.height!==w)&&this.setSize(_,w)}return b===!1&&P.setRenderTarget(a),p=P.toneMapping,P.toneMapping=ns,!0},this.hasRenderPass=function(){return b},this.end=function(P,T){P.toneMapping=p,m=!0;let _=a,w=o;for(let B=0;B<C.length;B++){const I=C[B];I.enabled!==!1&&(I.render(P,w,_,T),I.needsSwap!==!1&&(_=w,w=w===o?l:o))}if(x!==P.outputColorSpace||v!==P.toneMapping){x=P.outputColorSpace,v=P.toneMapping,u.defines={},_e.getTransfer(x)===Ce&&(u.defines.SRGB_TRANSFER="");const B=OS[v];B&&(u.defines[B]=""),u.needsUpdate=!0}u.uniforms.tDiffuse.value=_.texture,P.setRenderTarget(S),P.render(f,d),S=null,m=!1},this.isCompositing=function(){return m},this.dispose=function(){a.dispose(),o!==null&&o.dispose(),l!==null&&l.dispose(),h.dispose(),u.dispose()}}const $p=new zn,Yp=new Dr(1,1),qp=new Up(1),Kp=new Tp,Zp=new nx,Jp=new Ip,Gf=[],Vf=[],Wf=new Float32Array(16),Xf=new Float32Array(9),$f=new Float32Array(4);function Br(i,t,e){const n=i[0];if(n<=0||n>0)return i;const s=t*e;let r=Gf[s];if(r===void 0&&(r=new Float32Array(s),Gf[s]=r),t!==0){n.toArray(r,0);for(let a=1,o=0;a!==t;++a)o+=e,i[a].toArray(r,o)}return r}function mn(i,t){if(i.length!==t.length)return!1;for(let e=0,n=i.length;e<n;e++)if(i[e]!==t[e])return!1;return!0}function gn(i,t){for(let e=0,n=t.length;e<n;e++)i[e]=t[e]}function qo(i,t){let e=Vf[t];e===void 0&&(e=new Int32Array(t),Vf[t]=e);for(let n=0;n!==t;++n)e[n]=i.allocateTextureUnit();return e}function BS(i,t){const e=this.cache;e[0]!==t&&(i.uniform1f(this.addr,t),e[0]=t)}function zS(i,t){const e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y)&&(i.uniform2f(this.addr,t.x,t.y),e[0]=t.x,e[1]=t.y);else{if(mn(e,t))return;i.uniform2fv(this.addr,t),gn(e,t)}}function HS(i,t){const e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y||e[2]!==t.z)&&(i.uniform3f(this.addr,t.x,t.y,t.z),e[0]=t.x,e[1]=t.y,e[2]=t.z);else if(t.r!==void 0)(e[0]!==t.r||e[1]!==t.g||e[2]!==t.b)&&(i.uniform3f(this.addr,t.r,t.g,t.b),e[0]=t.r,e[1]=t.g,e[2]=t.b);else{if(mn(e,t))return;i.uniform3fv(this.addr,t),gn(e,t)}}function GS(i,t){const e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y||e[2]!==t.z||e[3]!==t.w)&&(i.uniform4f(this.addr,t.x,t.y,t.z,t.w),e[0]=t.x,e[1]=t.y,e[2]=t.z,e[3]=t.w);else{if(mn(e,t))return;i.uniform4fv(this.addr,t),gn(e,t)}}function VS(i,t){const e=this.cache,n=t.elements;if(n===void 0){if(mn(e,t))return;i.uniformMatrix2fv(this.addr,!1,t),gn(e,t)}else{if(mn(e,n))return;$f.set(n),i.uniformMatrix2fv(this.addr,!1,$f),gn(e,n)}}function WS(i,t){const e=this.cache,n=t.elements;if(n===void 0){if(mn(e,t))return;i.uniformMatrix3fv(this.addr,!1,t),gn(e,t)}else{if(mn(e,n))return;Xf.set(n),i.uniformMatrix3fv(this.addr,!1,Xf),gn(e,n)}}function XS(i,t){const e=this.cache,n=t.elements;if(n===void 0){if(mn(e,t))return;i.uniformMatrix4fv(this.addr,!1,t),gn(e,t)}else{if(mn(e,n))return;Wf.set(n),i.uniformMatrix4fv(this.addr,!1,Wf),gn(e,n)}}function $S(i,t){const e=this.cache;e[0]!==t&&(i.uniform1i(this.addr,t),e[0]=t)}function YS(i,t){const e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y)&&(i.uniform2i(this.addr,t.x,t.y),e[0]=t.x,e[1]=t.y);else{if(mn(e,t))return;i.uniform2iv(this.addr,t),gn(e,t)}}function qS(i,t){const e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y||e[2]!==t.z)&&(i.uniform3i(this.addr,t.x,t.y,t.z),e[0]=t.x,e[1]=t.y,e[2]=t.z);else{if(mn(e,t))return;i.uniform3iv(this.addr,t),gn(e,t)}}function KS(i,t){const e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y||e[2]!==t.z||e[3]!==t.w)&&(i.uniform4i(this.addr,t.x,t.y,t.z,t.w),e[0]=t.x,e[1]=t.y,e[2]=t.z,e[3]=t.w);else{if(mn(e,t))return;i.uniform4iv(this.addr,t),gn(e,t)}}function ZS(i,t){const e=this.cache;e[0]!==t&&(i.uniform1ui(this.addr,t),e[0]=t)}function JS(i,t){const e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y)&&(i.uniform2ui(this.addr,t.x,t.y),e[0]=t.x,e[1]=t.y);else{if(mn(e,t))return;i.uniform2uiv(this.addr,t),gn(e,t)}}function QS(i,t){const e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y||e[2]!==t.z)&&(i.uniform3ui(this.addr,t.x,t.y,t.z),e[0]=t.x,e[1]=t.y,e[2]=t.z);else{if(mn(e,t))return;i.uniform3uiv(this.addr,t),gn(e,t)}}function jS(i,t){const e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y||e[2]!==t.z||e[3]!==t.w)&&(i.uniform4ui(this.addr,t.x,t.y,t.z,t.w),e[0]=t.x,e[1]=t.y,e[2]=t.z,e[3]=t.w);else{if(mn(e,t))return;i.uniform4uiv(this.addr,t),gn(e,t)}}function Ko(i){return i.version===0&&(i.compareFunction=bp,i.needsUpdate=!0),i}function ty(i,t,e){const n=this.cache,s=e.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s);let r;this.type===i.SAMPLER_2D_SHADOW?r=Ko(Yp):r=$p,e.setTexture2D(t||r,s)}function ey(i,t,e){const n=this.cache,s=e.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s),e.setTexture3D(t||Zp,s)}function ny(i,t,e){const n=this.cache,s=e.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s);let r;this.type===i.SAMPLER_CUBE_SHADOW?r=Ko(qp):r=Jp,e.setTextureCube(t||r,s)}function iy(i,t,e){const n=this.cache,s=e.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s),e.setTexture2DArray(t||Kp,s)}function sy(i){switch(i){case 5126:return BS;case 35664:return zS;case 35665:return HS;case 35666:return GS;case 35674:return VS;case 35675:return WS;case 35676:return XS;case 5124:case 35670:return $S;case 35667:case 35671:return YS;case 35668:case 35672:return qS;case 35669:case 35673:return KS;case 5125:return ZS;case 36294:return JS;case 36295:return QS;case 36296:return jS;case 35678:case 36198:case 36298:case 36306:case 35682:return ty;case 35679:case 36299:case 36307:return ey;case 35680:case 36300:case 36308:case 36293:return ny;case 36289:case 36303:case 36311:case 36292:return iy}}function ry(i,t){i.uniform1fv(this.addr,t)}function ay(i,t){const e=Br(t,this.size,2);i.uniform2fv(this.addr,e)}function oy(i,t){const e=Br(t,this.size,3);i.uniform3fv(this.addr,e)}function ly(i,t){const e=Br(t,this.size,4);i.uniform4fv(this.addr,e)}function cy(i,t){const e=Br(t,this.size,4);i.uniformMatrix2fv(this.addr,!1,e)}function hy(i,t){const e=Br(t,this.size,9);i.uniformMatrix3fv(this.addr,!1,e)}function uy(i,t){const e=Br(t,this.size,16);i.uniformMatrix4fv(this.addr,!1,e)}function fy(i,t){i.uniform1iv(this.addr,t)}function dy(i,t){i.uniform2iv(this.addr,t)}function py(i,t){i.uniform3iv(this.addr,t)}function my(i,t){i.uniform4iv(this.addr,t)}function gy(i,t){i.uniform1uiv(this.addr,t)}function _y(i,t){i.uniform2uiv(this.addr,t)}function xy(i,t){i.uniform3uiv(this.addr,t)}function vy(i,t){i.uniform4uiv(this.addr,t)}function My(i,t,e){const n=this.cache,s=t.length,r=qo(e,s);mn(n,r)||(i.uniform1iv(this.addr,r),gn(n,r));let a;this.type===i.SAMPLER_2D_SHADOW?a=Ko(Yp):a=$p;for(let o=0;o!==s;++o)e.setTexture2D(t[o]||a,r[o])}function Sy(i,t,e){const n=this.cache,s=t.length,r=qo(e,s);mn(n,r)||(i.uniform1iv(this.addr,r),gn(n,r));for(let a=0;a!==s;++a)e.setTexture3D(t[a]||Zp,r[a])}function yy(i,t,e){const n=this.cache,s=t.length,r=qo(e,s);mn(n,r)||(i.uniform1iv(this.addr,r),gn(n,r));let a;this.type===i.SAMPLER_CUBE_SHADOW?a=Ko(qp):a=Jp;for(let o=0;o!==s;++o)e.setTextureCube(t[o]||a,r[o])}function Ey(i,t,e){const n=this.cache,s=t.length,r=qo(e,s);mn(n,r)||(i.uniform1iv(this.addr,r),gn(n,r));for(let a=0;a!==s;++a)e.setTexture2DArray(t[a]||Kp,r[a])}function by(i){switch(i){case 5126:return ry;case 35664:return ay;case 35665:return oy;case 35666:return ly;case 35674:return cy;case 35675:return hy;case 35676:return uy;case 5124:case 35670:return fy;case 35667:case 35671:return dy;case 35668:case 35672:return py;case 35669:case 35673:return my;case 5125:return gy;case 36294:return _y;case 36295:return xy;case 36296:return vy;case 35678:case 36198:case 36298:case 36306:case 35682:return My;case 35679:case 36299:case 36307:return Sy;case 35680:case 36300:case 36308:case 36293:return yy;case 36289:case 36303:case 36311:case 36292:return Ey}}class wy{constructor(t,e,n){this.id=t,this.addr=n,this.cache=[],this.type=e.type,this.setValue=sy(e.type)}}class Ty{constructor(t,e,n){this.id=t,this.addr=n,this.cache=[],this.type=e.type,this.size=e.size,this.setValue=by(e.type)}}class Ay{constructor(t){this.id=t,this.seq=[],this.map={}}setValue(t,e,n){const s=this.seq;for(let r=0,a=s.length;r!==a;++r){const o=s[r];o.setValue(t,e[o.id],n)}}}const Yl=/(\w+)(\])?(\[|\.)?/g;function Yf(i,t){i.seq.push(t),i.map[t.id]=t}function Ry(i,t,e){const n=i.name,s=n.length;for(Yl.lastIndex=0;;){const r=Yl.exec(n),a=Yl.lastIndex;let o=r[1];const l=r[2]==="]",c=r[3];if(l&&(o=o|0),c===void 0||c==="["&&a+2===s){Yf(e,c===void 0?new wy(o,i,t):new Ty(o,i,t));break}else{let u=e.map[o];u===void 0&&(u=new Ay(o),Yf(e,u)),e=u}}}class wo{constructor(t,e){this.seq=[],this.map={};const n=t.getProgramParameter(e,t.ACTIVE_UNIFORMS);for(let a=0;a<n;++a){const o=t.getActiveUniform(e,a),l=t.getUniformLocation(e,o.name);Ry(o,l,this)}const s=[],r=[];for(const a of this.seq)a.type===t.SAMPLER_2D_SHADOW||a.type===t.SAMPLER_CUBE_SHADOW||a.type===t.SAMPLER_2D_ARRAY_SHADOW?s.push(a):r.push(a);s.length>0&&(this.seq=s.concat(r))}setValue(t,e,n,s){const r=this.map[e];r!==void 0&&r.setValue(t,n,s)}setOptional(t,e,n){const s=e[n];s!==void 0&&this.setValue(t,n,s)}static upload(t,e,n,s){for(let r=0,a=e.length;r!==a;++r){const o=e[r],l=n[o.id];l.needsUpdate!==!1&&o.setValue(t,l.value,s)}}static seqWithValue(t,e){const n=[];for(let s=0,r=t.length;s!==r;++s){const a=t[s];a.id in e&&n.push(a)}return n}}function qf(i,t,e){const n=i.createShader(t);return i.shaderSource(n,e),i.compileShader(n),n}const Cy=37297;let Py=0;function Ly(i,t){const e=i.split(`
`),n=[],s=Math.max(t-6,0),r=Math.min(t+6,e.length);for(let a=s;a<r;a++){const o=a+1;n.push(`${o===t?">":" "} ${o}: ${e[a]}`)}return n.join(`
`)}const Kf=new ne;function Dy(i){_e._getMatrix(Kf,_e.workingColorSpace,i);const t=`mat3( ${Kf.elements.map(e=>e.toFixed(4))} )`;switch(_e.getTransfer(i)){case No:return[t,"LinearTransferOETF"];case Ce:return[t,"sRGBTransferOETF"];default:return Kt("WebGLProgram: Unsupported color space: ",i),[t,"LinearTransferOETF"]}}function Zf(i,t,e){const n=i.getShaderParameter(t,i.COMPILE_STATUS),r=(i.getShaderInfoLog(t)||"").trim();if(n&&r==="")return"";const a=/ERROR: 0:(\d+)/.exec(r);if(a){const o=parseInt(a[1]);return e.toUpperCase()+`

`+r+`

`+Ly(i.getShaderSource(t),o)}else return r}function Ny(i,t){const e=Dy(t);return[`vec4 ${i}( vec4 value ) {`,`	return ${e[1]}( vec4( ${e[0]} * value.rgb, value.a ) );`,"}"].join(`
`)}const Iy={[lp]:"Linear",[cp]:"Reinhard",[hp]:"Cineon",[up]:"ACESFilmic",[dp]:"AgX",[pp]:"Neutral",[fp]:"Custom"};function Uy(i,t){const e=Iy[t];return e===void 0?(Kt("WebGLProgram: Unsupported toneMapping:",t),"vec3 "+i+"( vec3 color ) { return LinearToneMapping( color ); }"):"vec3 "+i+"( vec3 color ) { return "+e+"ToneMapping( color ); }"}const ho=new W;function Fy(){_e.getLuminanceCoefficients(ho);const i=ho.x.toFixed(4),t=ho.y.toFixed(4),e=ho.z.toFixed(4);return["float luminance( const in vec3 rgb ) {",`	const vec3 weights = vec3( ${i}, ${t}, ${e} );`,"	return dot( weights, rgb );","}"].join(`
`)}function Oy(i){return[i.extensionClipCullDistance?"#extension GL_ANGLE_clip_cull_distance : require":"",i.extensionMultiDraw?"#extension GL_ANGLE_multi_draw : require":""].filter(da).join(`
`)}function ky(i){const t=[];for(const e in i){const n=i[e];n!==!1&&t.push("#define "+e+" "+n)}return t.join(`
`)}function By(i,t){const e={},n=i.getProgramParameter(t,i.ACTIVE_ATTRIBUTES);for(let s=0;s<n;s++){const r=i.getActiveAttrib(t,s),a=r.name;let o=1;r.type===i.FLOAT_MAT2&&(o=2),r.type===i.FLOAT_MAT3&&(o=3),r.type===i.FLOAT_MAT4&&(o=4),e[a]={type:r.type,location:i.getAttribLocation(t,a),locationSize:o}}return e}function da(i){return i!==""}function Jf(i,t){const e=t.numSpotLightShadows+t.numSpotLightMaps-t.numSpotLightShadowsWithMaps;return i.replace(/NUM_SUN_LIGHTS/g,t.numSunLights).replace(/NUM_DIR_LIGHTS/g,t.numDirLights).replace(/NUM_SPOT_LIGHTS/g,t.numSpotLights).replace(/NUM_SPOT_LIGHT_MAPS/g,t.numSpotLightMaps).replace(/NUM_SPOT_LIGHT_COORDS/g,e).replace(/NUM_RECT_AREA_LIGHTS/g,t.numRectAreaLights).replace(/NUM_POINT_LIGHTS/g,t.numPointLights).replace(/NUM_HEMI_LIGHTS/g,t.numHemiLights).replace(/NUM_SUN_LIGHT_SHADOWS/g,t.numSunLightShadows).replace(/NUM_DIR_LIGHT_SHADOWS/g,t.numDirLightShadows).replace(/NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS/g,t.numSpotLightShadowsWithMaps).replace(/NUM_SPOT_LIGHT_SHADOWS/g,t.numSpotLightShadows).replace(/NUM_POINT_LIGHT_SHADOWS/g,t.numPointLightShadows).replace(/NUM_LIGHT_PROBE_GRIDS/g,t.numLightProbeGrids)}function Qf(i,t){return i.replace(/NUM_CLIPPING_PLANES/g,t.numClippingPlanes).replace(/UNION_CLIPPING_PLANES/g,t.numClippingPlanes-t.numClipIntersection)}const zy=/^[ \t]*#include +<([\w\d./]+)>/gm;function Qc(i){return i.replace(zy,Hy)}function Hy(i,t){const e=oe[t];if(e===void 0)throw new Error("THREE.WebGLProgram: Can not resolve #include <"+t+">");return Qc(e)}const Gy=/#pragma unroll_loop_start\s+for\s*\(\s*int\s+i\s*=\s*(\d+)\s*;\s*i\s*<\s*(\d+)\s*;\s*i\s*\+\+\s*\)\s*{([\s\S]+?)}\s+#pragma unroll_loop_end/g;function jf(i){return i.replace(Gy,Vy)}function Vy(i,t,e,n){let s="";for(let r=parseInt(t);r<parseInt(e);r++)s+=n.replace(/\[\s*i\s*\]/g,"[ "+r+" ]").replace(/UNROLLED_LOOP_INDEX/g,r);return s}function td(i){let t=`precision ${i.precision} float;
	precision ${i.precision} int;
	precision ${i.precision} sampler2D;
	precision ${i.precision} samplerCube;
	precision ${i.precision} sampler3D;
	precision ${i.precision} sampler2DArray;
	precision ${i.precision} sampler2DShadow;
	precision ${i.precision} samplerCubeShadow;
	precision ${i.precision} sampler2DArrayShadow;
	precision ${i.precision} isampler2D;
	precision ${i.precision} isampler3D;
	precision ${i.precision} isamplerCube;
	precision ${i.precision} isampler2DArray;
	precision ${i.precision} usampler2D;
	precision ${i.precision} usampler3D;
	precision ${i.precision} usamplerCube;
	precision ${i.precision} usampler2DArray;
	`;return i.precision==="highp"?t+=`
#define HIGH_PRECISION`:i.precision==="mediump"?t+=`
#define MEDIUM_PRECISION`:i.precision==="lowp"&&(t+=`
#define LOW_PRECISION`),t}const Wy={[xo]:"SHADOWMAP_TYPE_PCF",[fa]:"SHADOWMAP_TYPE_VSM"};function Xy(i){return Wy[i.shadowMapType]||"SHADOWMAP_TYPE_BASIC"}const $y={[ya]:"ENVMAP_MODE_REFRACTION"};function Yy(i){return i.envMap===!1?"ENVMAP_MODE_REFLECTION":$y[i.envMapMode]||"ENVMAP_MODE_REFLECTION"}const qy={[mh]:"ENVMAP_BLENDING_MULTIPLY",[P0]:"ENVMAP_BLENDING_MIX",[L0]:"ENVMAP_BLENDING_ADD"};function Ky(i){return i.envMap===!1?"ENVMAP_BLENDING_NONE":qy[i.combine]||"ENVMAP_BLENDING_NONE"}function Zy(i,t,e,n){const s=i.getContext(),r=e.defines;let a=e.vertexShader,o=e.fragmentShader;const l=Xy(e),c=e.envMapPMREM===!0?"ENVMAP_TYPE_PMREM":"ENVMAP_TYPE_CUBE",h=Yy(e),u=Ky(e),f=Oy(e),d=ky(r),x=s.createProgram();let v,m,p=e.glslVersion?"#version "+e.glslVersion+`
`:"";e.isRawShaderMaterial?(v=["#define SHADER_TYPE "+e.shaderType,"#define SHADER_NAME "+e.shaderName,d].filter(da).join(`
`),v.length>0&&(v+=`
`),m=["#define SHADER_TYPE "+e.shaderType,"#define SHADER_NAME "+e.shaderName,d].filter(da).join(`
`),m.length>0&&(m+=`
`)):(v=[td(e),"#define SHADER_TYPE "+e.shaderType,"#define SHADER_NAME "+e.shaderName,d,e.extensionClipCullDistance?"#define USE_CLIP_DISTANCE":"",e.batching?"#define USE_BATCHING":"",e.batchingColor?"#define USE_BATCHING_COLOR":"",e.instancing?"#define USE_INSTANCING":"",e.instancingColor?"#define USE_INSTANCING_COLOR":"",e.instancingMorph?"#define USE_INSTANCING_MORPH":"",e.useFog&&e.fog?"#define USE_FOG":"",e.useFog&&e.fogExp2?"#define FOG_EXP2":"",e.map?"#define USE_MAP":"",e.envMap?"#define USE_ENVMAP":"",e.envMap?"#define "+h:"",e.lightMap?"#define USE_LIGHTMAP":"",e.aoMap?"#define USE_AOMAP":"",e.bumpMap?"#define USE_BUMPMAP":"",e.normalMap?"#define USE_NORMALMAP":"",e.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",e.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",e.displacementMap?"#define USE_DISPLACEMENTMAP":"",e.emissiveMap?"#define USE_EMISSIVEMAP":"",e.anisotropy?"#define USE_ANISOTROPY":"",e.anisotropyMap?"#define USE_ANISOTROPYMAP":"",e.clearcoatMap?"#define USE_CLEARCOATMAP":"",e.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",e.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",e.diffuseRoughnessMap?"#define USE_DIFFUSE_ROUGHNESSMAP":"",e.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",e.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",e.specularMap?"#define USE_SPECULARMAP":"",e.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",e.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",e.roughnessMap?"#define USE_ROUGHNESSMAP":"",e.metalnessMap?"#define USE_METALNESSMAP":"",e.alphaMap?"#define USE_ALPHAMAP":"",e.alphaHash?"#define USE_ALPHAHASH":"",e.transmission?"#define USE_TRANSMISSION":"",e.transmissionMap?"#define USE_TRANSMISSIONMAP":"",e.thicknessMap?"#define USE_THICKNESSMAP":"",e.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",e.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",e.mapUv?"#define MAP_UV "+e.mapUv:"",e.alphaMapUv?"#define ALPHAMAP_UV "+e.alphaMapUv:"",e.lightMapUv?"#define LIGHTMAP_UV "+e.lightMapUv:"",e.aoMapUv?"#define AOMAP_UV "+e.aoMapUv:"",e.emissiveMapUv?"#define EMISSIVEMAP_UV "+e.emissiveMapUv:"",e.bumpMapUv?"#define BUMPMAP_UV "+e.bumpMapUv:"",e.normalMapUv?"#define NORMALMAP_UV "+e.normalMapUv:"",e.displacementMapUv?"#define DISPLACEMENTMAP_UV "+e.displacementMapUv:"",e.metalnessMapUv?"#define METALNESSMAP_UV "+e.metalnessMapUv:"",e.roughnessMapUv?"#define ROUGHNESSMAP_UV "+e.roughnessMapUv:"",e.anisotropyMapUv?"#define ANISOTROPYMAP_UV "+e.anisotropyMapUv:"",e.clearcoatMapUv?"#define CLEARCOATMAP_UV "+e.clearcoatMapUv:"",e.clearcoatNormalMapUv?"#define CLEARCOAT_NORMALMAP_UV "+e.clearcoatNormalMapUv:"",e.clearcoatRoughnessMapUv?"#define CLEARCOAT_ROUGHNESSMAP_UV "+e.clearcoatRoughnessMapUv:"",e.diffuseRoughnessMapUv?"#define DIFFUSE_ROUGHNESSMAP_UV "+e.diffuseRoughnessMapUv:"",e.iridescenceMapUv?"#define IRIDESCENCEMAP_UV "+e.iridescenceMapUv:"",e.iridescenceThicknessMapUv?"#define IRIDESCENCE_THICKNESSMAP_UV "+e.iridescenceThicknessMapUv:"",e.sheenColorMapUv?"#define SHEEN_COLORMAP_UV "+e.sheenColorMapUv:"",e.sheenRoughnessMapUv?"#define SHEEN_ROUGHNESSMAP_UV "+e.sheenRoughnessMapUv:"",e.specularMapUv?"#define SPECULARMAP_UV "+e.specularMapUv:"",e.specularColorMapUv?"#define SPECULAR_COLORMAP_UV "+e.specularColorMapUv:"",e.specularIntensityMapUv?"#define SPECULAR_INTENSITYMAP_UV "+e.specularIntensityMapUv:"",e.transmissionMapUv?"#define TRANSMISSIONMAP_UV "+e.transmissionMapUv:"",e.thicknessMapUv?"#define THICKNESSMAP_UV "+e.thicknessMapUv:"",e.vertexTangents&&e.flatShading===!1?"#define USE_TANGENT":"",e.vertexNormals?"#define HAS_NORMAL":"",e.vertexColors?"#define USE_COLOR":"",e.vertexAlphas?"#define USE_COLOR_ALPHA":"",e.vertexUv1s?"#define USE_UV1":"",e.vertexUv2s?"#define USE_UV2":"",e.vertexUv3s?"#define USE_UV3":"",e.pointsUvs?"#define USE_POINTS_UV":"",e.flatShading?"#define FLAT_SHADED":"",e.skinning?"#define USE_SKINNING":"",e.morphTargets?"#define USE_MORPHTARGETS":"",e.morphNormals&&e.flatShading===!1?"#define USE_MORPHNORMALS":"",e.morphColors?"#define USE_MORPHCOLORS":"",e.morphTargetsCount>0?"#define MORPHTARGETS_TEXTURE_STRIDE "+e.morphTextureStride:"",e.morphTargetsCount>0?"#define MORPHTARGETS_COUNT "+e.morphTargetsCount:"",e.doubleSided?"#define DOUBLE_SIDED":"",e.flipSided?"#define FLIP_SIDED":"",e.shadowMapEnabled?"#define USE_SHADOWMAP":"",e.shadowMapEnabled?"#define "+l:"",e.sizeAttenuation?"#define USE_SIZEATTENUATION":"",e.numLightProbes>0?"#define USE_LIGHT_PROBES":"",e.logarithmicDepthBuffer?"#define USE_LOGARITHMIC_DEPTH_BUFFER":"",e.reversedDepthBuffer?"#define USE_REVERSED_DEPTH_BUFFER":"","uniform mat4 modelMatrix;","uniform mat4 modelViewMatrix;","uniform mat4 projectionMatrix;","uniform mat4 viewMatrix;","uniform mat3 normalMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;","#ifdef USE_INSTANCING","	attribute mat4 instanceMatrix;","#endif","#ifdef USE_INSTANCING_COLOR","	attribute vec3 instanceColor;","#endif","#ifdef USE_INSTANCING_MORPH","	uniform sampler2D morphTexture;","#endif","attribute vec3 position;","attribute vec3 normal;","attribute vec2 uv;","#ifdef USE_UV1","	attribute vec2 uv1;","#endif","#ifdef USE_UV2","	attribute vec2 uv2;","#endif","#ifdef USE_UV3","	attribute vec2 uv3;","#endif","#ifdef USE_TANGENT","	attribute vec4 tangent;","#endif","#if defined( USE_COLOR_ALPHA )","	attribute vec4 color;","#elif defined( USE_COLOR )","	attribute vec3 color;","#endif","#ifdef USE_SKINNING","	attribute vec4 skinIndex;","	attribute vec4 skinWeight;","#endif",`
`].filter(da).join(`
`),m=[td(e),"#define SHADER_TYPE "+e.shaderType,"#define SHADER_NAME "+e.shaderName,d,e.useFog&&e.fog?"#define USE_FOG":"",e.useFog&&e.fogExp2?"#define FOG_EXP2":"",e.alphaToCoverage?"#define ALPHA_TO_COVERAGE":"",e.map?"#define USE_MAP":"",e.matcap?"#define USE_MATCAP":"",e.envMap?"#define USE_ENVMAP":"",e.envMap?"#define "+c:"",e.envMap?"#define "+h:"",e.envMap?"#define "+u:"",e.envMapPMREM?"#define ENVMAP_MAX_LOD "+e.envMapMaxLod+".0":"",e.envMapPMREM?"#define ENVMAP_SIZE "+e.envMapSize+".0":"",e.lightMap?"#define USE_LIGHTMAP":"",e.aoMap?"#define USE_AOMAP":"",e.bumpMap?"#define USE_BUMPMAP":"",e.normalMap?"#define USE_NORMALMAP":"",e.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",e.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",e.packedNormalMap?"#define USE_PACKED_NORMALMAP":"",e.emissiveMap?"#define USE_EMISSIVEMAP":"",e.anisotropy?"#define USE_ANISOTROPY":"",e.anisotropyMap?"#define USE_ANISOTROPYMAP":"",e.clearcoat?"#define USE_CLEARCOAT":"",e.clearcoatMap?"#define USE_CLEARCOATMAP":"",e.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",e.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",e.diffuseRoughness?"#define USE_DIFFUSE_ROUGHNESS":"",e.diffuseRoughnessMap?"#define USE_DIFFUSE_ROUGHNESSMAP":"",e.dispersion?"#define USE_DISPERSION":"",e.retroreflection?"#define USE_RETROREFLECTION":"",e.iridescence?"#define USE_IRIDESCENCE":"",e.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",e.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",e.specularMap?"#define USE_SPECULARMAP":"",e.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",e.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",e.roughnessMap?"#define USE_ROUGHNESSMAP":"",e.metalnessMap?"#define USE_METALNESSMAP":"",e.alphaMap?"#define USE_ALPHAMAP":"",e.alphaTest?"#define USE_ALPHATEST":"",e.alphaHash?"#define USE_ALPHAHASH":"",e.sheen?"#define USE_SHEEN":"",e.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",e.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",e.transmission?"#define USE_TRANSMISSION":"",e.transmissionMap?"#define USE_TRANSMISSIONMAP":"",e.thicknessMap?"#define USE_THICKNESSMAP":"",e.vertexTangents&&e.flatShading===!1?"#define USE_TANGENT":"",e.vertexColors||e.instancingColor?"#define USE_COLOR":"",e.vertexAlphas||e.batchingColor?"#define USE_COLOR_ALPHA":"",e.vertexUv1s?"#define USE_UV1":"",e.vertexUv2s?"#define USE_UV2":"",e.vertexUv3s?"#define USE_UV3":"",e.pointsUvs?"#define USE_POINTS_UV":"",e.gradientMap?"#define USE_GRADIENTMAP":"",e.flatShading?"#define FLAT_SHADED":"",e.doubleSided?"#define DOUBLE_SIDED":"",e.flipSided?"#define FLIP_SIDED":"",e.shadowMapEnabled?"#define USE_SHADOWMAP":"",e.shadowMapEnabled?"#define "+l:"",e.premultipliedAlpha?"#define PREMULTIPLIED_ALPHA":"",e.numLightProbes>0?"#define USE_LIGHT_PROBES":"",e.decodeVideoTexture?"#define DECODE_VIDEO_TEXTURE":"",e.decodeVideoTextureEmissive?"#define DECODE_VIDEO_TEXTURE_EMISSIVE":"",e.logarithmicDepthBuffer?"#define USE_LOGARITHMIC_DEPTH_BUFFER":"",e.reversedDepthBuffer?"#define USE_REVERSED_DEPTH_BUFFER":"","uniform mat4 viewMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;",e.toneMapping!==ns?"#define TONE_MAPPING":"",e.toneMapping!==ns?oe.tonemapping_pars_fragment:"",e.toneMapping!==ns?Uy("toneMapping",e.toneMapping):"",e.dithering?"#define DITHERING":"",e.opaque?"#define OPAQUE":"",oe.colorspace_pars_fragment,Ny("linearToOutputTexel",e.outputColorSpace),Fy(),e.useDepthPacking?"#define DEPTH_PACKING "+e.depthPacking:"",`
`].filter(da).join(`
`)),a=Qc(a),a=Jf(a,e),a=Qf(a,e),o=Qc(o),o=Jf(o,e),o=Qf(o,e),a=jf(a),o=jf(o),e.isRawShaderMaterial!==!0&&(p=`#version 300 es
`,v=[f,"#define attribute in","#define varying out","#define texture2D texture"].join(`
`)+`
`+v,m=["#define varying in",e.glslVersion===af?"":"layout(location = 0) out highp vec4 pc_fragColor;",e.glslVersion===af?"":"#define gl_FragColor pc_fragColor","#define gl_FragDepthEXT gl_FragDepth","#define texture2D texture","#define textureCube texture","#define texture2DProj textureProj","#define texture2DLodEXT textureLod","#define texture2DProjLodEXT textureProjLod","#define textureCubeLodEXT textureLod","#define texture2DGradEXT textureGrad","#define texture2DProjGradEXT textureProjGrad","#define textureCubeGradEXT textureGrad"].join(`
`)+`
`+m);const S=p+v+a,C=p+m+o,b=qf(s,s.VERTEX_SHADER,S),P=qf(s,s.FRAGMENT_SHADER,C);s.attachShader(x,b),s.attachShader(x,P),e.index0AttributeName!==void 0?s.bindAttribLocation(x,0,e.index0AttributeName):e.hasPositionAttribute===!0&&s.bindAttribLocation(x,0,"position"),s.linkProgram(x);function T(I){if(i.debug.checkShaderErrors){const D=s.getProgramInfoLog(x)||"",z=s.getShaderInfoLog(b)||"",V=s.getShaderInfoLog(P)||"",N=D.trim(),H=z.trim(),K=V.trim();let k=!0,lt=!0;if(s.getProgramParameter(x,s.LINK_STATUS)===!1)if(k=!1,typeof i.debug.onShaderError=="function")i.debug.onShaderError(s,x,b,P);else{const Z=Zf(s,b,"vertex"),Q=Zf(s,P,"fragment");Ee("WebGLProgram: Shader Error "+s.getError()+" - VALIDATE_STATUS "+s.getProgramParameter(x,s.VALIDATE_STATUS)+`

Material Name: `+I.name+`
Material Type: `+I.type+`

Program Info Log: `+N+`
`+Z+`
`+Q)}else N!==""?Kt("WebGLProgram: Program Info Log:",N):(H===""||K==="")&&(lt=!1);lt&&(I.diagnostics={runnable:k,programLog:N,vertexShader:{log:H,prefix:v},fragmentShader:{log:K,prefix:m}})}s.deleteShader(b),s.deleteShader(P),_=new wo(s,x),w=By(s,x)}let _;this.getUniforms=function(){return _===void 0&&T(this),_};let w;this.getAttributes=function(){return w===void 0&&T(this),w};let B=e.rendererExtensionParallelShaderCompile===!1;return this.isReady=function(){return B===!1&&(B=s.getProgramParameter(x,Cy)),B},this.destroy=function(){n.releaseStatesOfProgram(this),s.deleteProgram(x),this.program=void 0},this.type=e.shaderType,this.name=e.shaderName,this.id=Py++,this.cacheKey=t,this.usedTimes=1,this.program=x,this.vertexShader=b,this.fragmentShader=P,this}let Jy=0;class Qy{constructor(){this.shaderCache=new Map,this.materialCache=new Map}update(t,e,n){const s=this._getShaderCacheForMaterial(t);return s.has(e)===!1&&(s.add(e),e.usedTimes++),s.has(n)===!1&&(s.add(n),n.usedTimes++),this}remove(t){const e=this.materialCache.get(t);for(const n of e)n.usedTimes--,n.usedTimes===0&&this.shaderCache.delete(n.code);return this.materialCache.delete(t),this}getVertexShaderStage(t){return this._getShaderStage(t.vertexShader)}getFragmentShaderStage(t){return this._getShaderStage(t.fragmentShader)}dispose(){this.shaderCache.clear(),this.materialCache.clear()}_getShaderCacheForMaterial(t){const e=this.materialCache;let n=e.get(t);return n===void 0&&(n=new Set,e.set(t,n)),n}_getShaderStage(t){const e=this.shaderCache;let n=e.get(t);return n===void 0&&(n=new jy(t),e.set(t,n)),n}}class jy{constructor(t){this.id=Jy++,this.code=t,this.usedTimes=0}}function tE(i){return i===zs||i===Po||i===Lo}function eE(i,t,e,n,s,r){const a=new Ap,o=new Qy,l=new Set,c=[],h=new Map,u=n.logarithmicDepthBuffer,f={MeshDepthMaterial:"depth",MeshDistanceMaterial:"distance",MeshNormalMaterial:"normal",MeshBasicMaterial:"basic",MeshLambertMaterial:"lambert",MeshPhongMaterial:"phong",MeshToonMaterial:"toon",MeshStandardMaterial:"physical",MeshPhysicalMaterial:"physical",MeshMatcapMaterial:"matcap",LineBasicMaterial:"basic",LineDashedMaterial:"dashed",PointsMaterial:"points",ShadowMaterial:"shadow",SpriteMaterial:"sprite"};function d(_){return l.add(_),_===0?"uv":`uv${_}`}function x(_,w,B,I,D,z){const V=I.fog,N=D.geometry,H=_.isMeshStandardMaterial||_.isMeshLambertMaterial||_.isMeshPhongMaterial?I.environment:null,K=_.isMeshStandardMaterial||_.isMeshLambertMaterial&&!_.envMap||_.isMeshPhongMaterial&&!_.envMap,k=t.get(_.envMap||H,K),lt=f[_.type];let Z=n.precision;_.precision!==null&&(Z=n.getMaxPrecision(_.precision),Z!==_.precision&&Kt("WebGLProgram.getParameters:",_.precision,"not supported, using",Z,"instead."));const Q=N.morphAttributes.position||N.morphAttributes.normal||N.morphAttributes.color,it=Q!==void 0?Q.length:0;let ut=0;N.morphAttributes.position!==void 0&&(ut=1),N.morphAttributes.normal!==void 0&&(ut=2),N.morphAttributes.color!==void 0&&(ut=3);let ht,j,pt,_t;if(lt){const At=Di[lt];ht=At.vertexShader,j=At.fragmentShader}else{ht=_.vertexShader,j=_.fragmentShader;const At=o.getVertexShaderStage(_),ie=o.getFragmentShaderStage(_);o.update(_,At,ie),pt=At.id,_t=ie.id}const Tt=i.getRenderTarget(),St=i.state.buffers.depth.getReversed(),Gt=D.isInstancedMesh===!0,jt=D.isBatchedMesh===!0,zt=!!_.map,le=!!_.matcap,re=!!k,Jt=re&&k.isPMREMTexture===!0,Ge=!!_.aoMap,Fe=!!_.lightMap,tn=!!_.bumpMap&&_.wireframe===!1,Le=!!_.normalMap,xn=!!_.displacementMap,xe=!!_.emissiveMap,hn=!!_.metalnessMap,Xe=!!_.roughnessMap,en=_.anisotropy>0,F=_.clearcoat>0,Rt=_.diffuseRoughness>0,Xt=_.dispersion>0,te=_.retroreflectivity>0,yt=_.iridescence>0,Ne=_.sheen>0,Bt=_.transmission>0,Wt=en&&!!_.anisotropyMap,A=F&&!!_.clearcoatMap,M=F&&!!_.clearcoatNormalMap,X=F&&!!_.clearcoatRoughnessMap,ct=Rt&&!!_.diffuseRoughnessMap,rt=yt&&!!_.iridescenceMap,gt=yt&&!!_.iridescenceThicknessMap,xt=Ne&&!!_.sheenColorMap,tt=Ne&&!!_.sheenRoughnessMap,nt=!!_.specularMap,dt=!!_.specularColorMap,U=!!_.specularIntensityMap,st=Bt&&!!_.transmissionMap,et=Bt&&!!_.thicknessMap,Et=!!_.gradientMap,mt=!!_.alphaMap,Mt=_.alphaTest>0,Ht=!!_.alphaHash,Yt=!!_.extensions;let ot=ns;_.toneMapped&&(Tt===null||Tt.isXRRenderTarget===!0)&&(ot=i.toneMapping);const Ft=Jt?k.isCompressedCubeTexture?k.image[0].mipmaps:k.mipmaps:null,qt={shaderID:lt,shaderType:_.type,shaderName:_.name,vertexShader:ht,fragmentShader:j,defines:_.defines,customVertexShaderID:pt,customFragmentShaderID:_t,isRawShaderMaterial:_.isRawShaderMaterial===!0,glslVersion:_.glslVersion,precision:Z,batching:jt,batchingColor:jt&&D._colorsTexture!==null,instancing:Gt,instancingColor:Gt&&D.instanceColor!==null,instancingMorph:Gt&&D.morphTexture!==null,outputColorSpace:Tt===null?i.outputColorSpace:Tt.isXRRenderTarget===!0?Tt.texture.colorSpace:_e.workingColorSpace,alphaToCoverage:!!_.alphaToCoverage,map:zt,matcap:le,envMap:re,envMapMode:re&&k.mapping,envMapPMREM:Jt,envMapMaxLod:Jt?Ft.length-1:null,envMapSize:Jt?Ft[0].width:null,aoMap:Ge,lightMap:Fe,bumpMap:tn,normalMap:Le,displacementMap:xn,emissiveMap:xe,normalMapObjectSpace:Le&&_.normalMapType===I0,normalMapTangentSpace:Le&&_.normalMapType===Kc,packedNormalMap:Le&&_.normalMapType===Kc&&tE(_.normalMap.format),metalnessMap:hn,roughnessMap:Xe,anisotropy:en,anisotropyMap:Wt,clearcoat:F,clearcoatMap:A,clearcoatNormalMap:M,clearcoatRoughnessMap:X,diffuseRoughness:Rt,diffuseRoughnessMap:ct,dispersion:Xt,retroreflection:te,iridescence:yt,iridescenceMap:rt,iridescenceThicknessMap:gt,sheen:Ne,sheenColorMap:xt,sheenRoughnessMap:tt,specularMap:nt,specularColorMap:dt,specularIntensityMap:U,transmission:Bt,transmissionMap:st,thicknessMap:et,gradientMap:Et,opaque:_.transparent===!1&&_.blending===xa&&_.alphaToCoverage===!1,alphaMap:mt,alphaTest:Mt,alphaHash:Ht,combine:_.combine,mapUv:zt&&d(_.map.channel),aoMapUv:Ge&&d(_.aoMap.channel),lightMapUv:Fe&&d(_.lightMap.channel),bumpMapUv:tn&&d(_.bumpMap.channel),normalMapUv:Le&&d(_.normalMap.channel),displacementMapUv:xn&&d(_.displacementMap.channel),emissiveMapUv:xe&&d(_.emissiveMap.channel),metalnessMapUv:hn&&d(_.metalnessMap.channel),roughnessMapUv:Xe&&d(_.roughnessMap.channel),anisotropyMapUv:Wt&&d(_.anisotropyMap.channel),clearcoatMapUv:A&&d(_.clearcoatMap.channel),clearcoatNormalMapUv:M&&d(_.clearcoatNormalMap.channel),clearcoatRoughnessMapUv:X&&d(_.clearcoatRoughnessMap.channel),diffuseRoughnessMapUv:ct&&d(_.diffuseRoughnessMap.channel),iridescenceMapUv:rt&&d(_.iridescenceMap.channel),iridescenceThicknessMapUv:gt&&d(_.iridescenceThicknessMap.channel),sheenColorMapUv:xt&&d(_.sheenColorMap.channel),sheenRoughnessMapUv:tt&&d(_.sheenRoughnessMap.channel),specularMapUv:nt&&d(_.specularMap.channel),specularColorMapUv:dt&&d(_.specularColorMap.channel),specularIntensityMapUv:U&&d(_.specularIntensityMap.channel),transmissionMapUv:st&&d(_.transmissionMap.channel),thicknessMapUv:et&&d(_.thicknessMap.channel),alphaMapUv:mt&&d(_.alphaMap.channel),vertexTangents:!!N.attributes.tangent&&(Le||en),vertexNormals:!!N.attributes.normal,vertexColors:_.vertexColors,vertexAlphas:_.vertexColors===!0&&!!N.attributes.color&&N.attributes.color.itemSize===4,pointsUvs:D.isPoints===!0&&!!N.attributes.uv&&(zt||mt),fog:!!V,useFog:_.fog===!0,fogExp2:!!V&&V.isFogExp2,flatShading:_.wireframe===!1&&(_.flatShading===!0||N.attributes.normal===void 0&&Le===!1&&(_.isMeshLambertMaterial||_.isMeshPhongMaterial||_.isMeshStandardMaterial||_.isMeshPhysicalMaterial)),sizeAttenuation:_.sizeAttenuation===!0,logarithmicDepthBuffer:u,reversedDepthBuffer:St,skinning:D.isSkinnedMesh===!0,hasPositionAttribute:N.attributes.position!==void 0,morphTargets:N.morphAttributes.position!==void 0,morphNormals:N.morphAttributes.normal!==void 0,morphColors:N.morphAttributes.color!==void 0,morphTargetsCount:it,morphTextureStride:ut,numSunLights:w.sun.length,numDirLights:w.directional.length,numPointLights:w.point.length,numSpotLights:w.spot.length,numSpotLightMaps:w.spotLightMap.length,numRectAreaLights:w.rectArea.length,numHemiLights:w.hemi.length,numSunLightShadows:w.sunShadowMap.length,numDirLightShadows:w.directionalShadowMap.length,numPointLightShadows:w.pointShadowMap.length,numSpotLightShadows:w.spotShadowMap.length,numSpotLightShadowsWithMaps:w.numSpotLightShadowsWithMaps,numLightProbes:w.numLightProbes,numLightProbeGrids:z.filter(At=>At.texture!==null).length,numClippingPlanes:r.numPlanes,numClipIntersection:r.numIntersection,dithering:_.dithering,shadowMapEnabled:i.shadowMap.enabled&&B.length>0,shadowMapType:i.shadowMap.type,toneMapping:ot,decodeVideoTexture:zt&&_.map.isVideoTexture===!0&&_e.getTransfer(_.map.colorSpace)===Ce,decodeVideoTextureEmissive:xe&&_.emissiveMap.isVideoTexture===!0&&_e.getTransfer(_.emissiveMap.colorSpace)===Ce,premultipliedAlpha:_.premultipliedAlpha,doubleSided:_.side===Qi,flipSided:_.side===Vn,useDepthPacking:_.depthPacking>=0,depthPacking:_.depthPacking||0,index0AttributeName:_.index0AttributeName,extensionClipCullDistance:Yt&&_.extensions.clipCullDistance===!0&&e.has("WEBGL_clip_cull_distance"),extensionMultiDraw:(Yt&&_.extensions.multiDraw===!0||jt)&&e.has("WEBGL_multi_draw"),rendererExtensionParallelShaderCompile:e.has("KHR_parallel_shader_compile"),customProgramCacheKey:_.customProgramCacheKey()};return qt.vertexUv1s=l.has(1),qt.vertexUv2s=l.has(2),qt.vertexUv3s=l.has(3),l.clear(),qt}function v(_){const w=[];if(_.shaderID?w.push(_.shaderID):(w.push(_.customVertexShaderID),w.push(_.customFragmentShaderID)),_.defines!==void 0)for(const B in _.defines)w.push(B),w.push(_.defines[B]);return _.isRawShaderMaterial===!1&&(m(w,_),p(w,_),w.push(i.outputColorSpace)),w.push(_.customProgramCacheKey),w.join()}function m(_,w){_.push(w.precision),_.push(w.outputColorSpace),_.push(w.envMapMode),_.push(w.envMapPMREM),_.push(w.envMapMaxLod),_.push(w.envMapSize),_.push(w.mapUv),_.push(w.alphaMapUv),_.push(w.lightMapUv),_.push(w.aoMapUv),_.push(w.bumpMapUv),_.push(w.normalMapUv),_.push(w.displacementMapUv),_.push(w.emissiveMapUv),_.push(w.metalnessMapUv),_.push(w.roughnessMapUv),_.push(w.anisotropyMapUv),_.push(w.clearcoatMapUv),_.push(w.clearcoatNormalMapUv),_.push(w.clearcoatRoughnessMapUv),_.push(w.diffuseRoughnessMapUv),_.push(w.iridescenceMapUv),_.push(w.iridescenceThicknessMapUv),_.push(w.sheenColorMapUv),_.push(w.sheenRoughnessMapUv),_.push(w.specularMapUv),_.push(w.specularColorMapUv),_.push(w.specularIntensityMapUv),_.push(w.transmissionMapUv),_.push(w.thicknessMapUv),_.push(w.combine),_.push(w.fogExp2),_.push(w.sizeAttenuation),_.push(w.morphTargetsCount),_.push(w.numSunLights),_.push(w.numDirLights),_.push(w.numPointLights),_.push(w.numSpotLights),_.push(w.numSpotLightMaps),_.push(w.numHemiLights),_.push(w.numRectAreaLights),_.push(w.numSunLightShadows),_.push(w.numDirLightShadows),_.push(w.numPointLightShadows),_.push(w.numSpotLightShadows),_.push(w.numSpotLightShadowsWithMaps),_.push(w.numLightProbes),_.push(w.numLightProbeGrids),_.push(w.shadowMapType),_.push(w.toneMapping),_.push(w.numClippingPlanes),_.push(w.numClipIntersection),_.push(w.depthPacking)}function p(_,w){a.disableAll(),w.instancing&&a.enable(0),w.instancingColor&&a.enable(1),w.instancingMorph&&a.enable(2),w.matcap&&a.enable(3),w.envMap&&a.enable(4),w.normalMapObjectSpace&&a.enable(5),w.normalMapTangentSpace&&a.enable(6),w.clearcoat&&a.enable(7),w.iridescence&&a.enable(8),w.alphaTest&&a.enable(9),w.vertexColors&&a.enable(10),w.vertexAlphas&&a.enable(11),w.vertexUv1s&&a.enable(12),w.vertexUv2s&&a.enable(13),w.vertexUv3s&&a.enable(14),w.vertexTangents&&a.enable(15),w.anisotropy&&a.enable(16),w.alphaHash&&a.enable(17),w.batching&&a.enable(18),w.dispersion&&a.enable(19),w.retroreflection&&a.enable(24),w.diffuseRoughness&&a.enable(25),w.batchingColor&&a.enable(20),w.gradientMap&&a.enable(21),w.packedNormalMap&&a.enable(22),w.vertexNormals&&a.enable(23),_.push(a.mask),a.disableAll(),w.fog&&a.enable(0),w.useFog&&a.enable(1),w.flatShading&&a.enable(2),w.logarithmicDepthBuffer&&a.enable(3),w.reversedDepthBuffer&&a.enable(4),w.skinning&&a.enable(5),w.morphTargets&&a.enable(6),w.morphNormals&&a.enable(7),w.morphColors&&a.enable(8),w.premultipliedAlpha&&a.enable(9),w.shadowMapEnabled&&a.enable(10),w.doubleSided&&a.enable(11),w.flipSided&&a.enable(12),w.useDepthPacking&&a.enable(13),w.dithering&&a.enable(14),w.transmission&&a.enable(15),w.sheen&&a.enable(16),w.opaque&&a.enable(17),w.pointsUvs&&a.enable(18),w.decodeVideoTexture&&a.enable(19),w.decodeVideoTextureEmissive&&a.enable(20),w.alphaToCoverage&&a.enable(21),w.numLightProbeGrids>0&&a.enable(22),w.hasPositionAttribute&&a.enable(23),_.push(a.mask)}function S(_){const w=f[_.type];let B;if(w){const I=Di[w];B=Ex.clone(I.uniforms)}else B=_.uniforms;return B}function C(_,w){let B=h.get(w);return B!==void 0?++B.usedTimes:(B=new Zy(i,w,_,s),c.push(B),h.set(w,B)),B}function b(_){if(--_.usedTimes===0){const w=c.indexOf(_);c[w]=c[c.length-1],c.pop(),h.delete(_.cacheKey),_.destroy()}}function P(_){o.remove(_)}function T(){o.dispose()}return{getParameters:x,getProgramCacheKey:v,getUniforms:S,acquireProgram:C,releaseProgram:b,releaseShaderCache:P,programs:c,dispose:T}}function nE(){let i=new WeakMap;function t(a){return i.has(a)}function e(a){let o=i.get(a);return o===void 0&&(o={},i.set(a,o)),o}function n(a){i.delete(a)}function s(a,o,l){i.get(a)[o]=l}function r(){i=new WeakMap}return{has:t,get:e,remove:n,update:s,dispose:r}}function iE(i,t){return i.groupOrder!==t.groupOrder?i.groupOrder-t.groupOrder:i.renderOrder!==t.renderOrder?i.renderOrder-t.renderOrder:i.material.id!==t.material.id?i.material.id-t.material.id:i.materialVariant!==t.materialVariant?i.materialVariant-t.materialVariant:i.z!==t.z?i.z-t.z:i.id-t.id}function ed(i,t){return i.groupOrder!==t.groupOrder?i.groupOrder-t.groupOrder:i.renderOrder!==t.renderOrder?i.renderOrder-t.renderOrder:i.z!==t.z?t.z-i.z:i.id-t.id}function nd(){const i=[];let t=0;const e=[],n=[],s=[];function r(){t=0,e.length=0,n.length=0,s.length=0}function a(f){let d=0;return f.isInstancedMesh&&(d+=2),f.isSkinnedMesh&&(d+=1),d}function o(f,d,x,v,m,p){let S=i[t];return S===void 0?(S={id:f.id,object:f,geometry:d,material:x,materialVariant:a(f),groupOrder:v,renderOrder:f.renderOrder,z:m,group:p},i[t]=S):(S.id=f.id,S.object=f,S.geometry=d,S.material=x,S.materialVariant=a(f),S.groupOrder=v,S.renderOrder=f.renderOrder,S.z=m,S.group=p),t++,S}function l(f,d,x,v,m,p,S){S.reversedDepth===!0&&(m=-m);const C=o(f,d,x,v,m,p);x.transmission>0?n.push(C):x.transparent===!0?s.push(C):e.push(C)}function c(f,d,x,v,m,p){const S=o(f,d,x,v,m,p);x.transmission>0?n.unshift(S):x.transparent===!0?s.unshift(S):e.unshift(S)}function h(f,d){e.length>1&&e.sort(f||iE),n.length>1&&n.sort(d||ed),s.length>1&&s.sort(d||ed)}function u(){for(let f=t,d=i.length;f<d;f++){const x=i[f];if(x.id===null)break;x.id=null,x.object=null,x.geometry=null,x.material=null,x.group=null}}return{opaque:e,transmissive:n,transparent:s,init:r,push:l,unshift:c,finish:u,sort:h}}function sE(){let i=new WeakMap;function t(n,s){const r=i.get(n);let a;return r===void 0?(a=new nd,i.set(n,[a])):s>=r.length?(a=new nd,r.push(a)):a=r[s],a}function e(){i=new WeakMap}return{get:t,dispose:e}}function rE(){const i={};return{get:function(t){if(i[t.id]!==void 0)return i[t.id];let e;switch(t.type){case"SunLight":case"DirectionalLight":e={direction:new W,color:new se};break;case"SpotLight":e={position:new W,direction:new W,color:new se,distance:0,coneCos:0,penumbraCos:0,decay:0};break;case"PointLight":e={position:new W,color:new se,distance:0,decay:0};break;case"HemisphereLight":e={direction:new W,skyColor:new se,groundColor:new se};break;case"RectAreaLight":e={color:new se,position:new W,halfWidth:new W,halfHeight:new W};break}return i[t.id]=e,e}}}function aE(){const i={};return{get:function(t){if(i[t.id]!==void 0)return i[t.id];let e;switch(t.type){case"SunLight":case"DirectionalLight":e={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new ee};break;case"SpotLight":e={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new ee};break;case"PointLight":e={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new ee,shadowCameraNear:1,shadowCameraFar:1e3};break}return i[t.id]=e,e}}}let oE=0;function lE(i,t){return(t.castShadow?2:0)-(i.castShadow?2:0)+(t.map?1:0)-(i.map?1:0)}function cE(i){const t=new rE,e=aE(),n={version:0,hash:{sunLength:-1,directionalLength:-1,pointLength:-1,spotLength:-1,rectAreaLength:-1,hemiLength:-1,numSunShadows:-1,numDirectionalShadows:-1,numPointShadows:-1,numSpotShadows:-1,numSpotMaps:-1,numLightProbes:-1},ambient:[0,0,0],probe:[],sun:[],sunShadow:[],sunShadowMap:[],sunShadowMatrix:[],sunShadowCascade:[],directional:[],directionalShadow:[],directionalShadowMap:[],directionalShadowMatrix:[],spot:[],spotLightMap:[],spotShadow:[],spotShadowMap:[],spotLightMatrix:[],rectArea:[],rectAreaLTC1:null,rectAreaLTC2:null,point:[],pointShadow:[],pointShadowMap:[],pointShadowMatrix:[],hemi:[],numSpotLightShadowsWithMaps:0,numLightProbes:0};for(let c=0;c<9;c++)n.probe.push(new W);const s=new W,r=new Pe,a=new Pe;function o(c){let h=0,u=0,f=0;for(let z=0;z<9;z++)n.probe[z].set(0,0,0);let d=0,x=0,v=0,m=0,p=0,S=0,C=0,b=0,P=0,T=0,_=0,w=0,B=0,I=0;c.sort(lE);for(let z=0,V=c.length;z<V;z++){const N=c[z],H=N.color,K=N.intensity,k=N.distance;let lt=null;if(N.shadow&&N.shadow.map&&(N.shadow.map.texture.format===zs?lt=N.shadow.map.texture:lt=N.shadow.map.depthTexture||N.shadow.map.texture),N.isAmbientLight)h+=H.r*K,u+=H.g*K,f+=H.b*K;else if(N.isLightProbe){for(let Z=0;Z<9;Z++)n.probe[Z].addScaledVector(N.sh.coefficients[Z],K);I++}else if(N.isSunLight){const Z=t.get(N);if(Z.color.copy(N.color).multiplyScalar(N.intensity),N.castShadow){const Q=N.shadow,it=e.get(N);it.shadowIntensity=Q.intensity,it.shadowBias=Q.bias,it.shadowNormalBias=Q.normalBias,it.shadowRadius=Q.radius,it.shadowMapSize.copy(Q.mapSize).multiply(Q.getFrameExtents()),n.sunShadow[x]=it,n.sunShadowMap[x]=lt;const ut=Q.getViewportCount();for(let ht=0;ht<ut;ht++)n.sunShadowMatrix[v+ht]=Q.getMatrix(ht),n.sunShadowCascade[v+ht]=Q._cascadeData[ht];v+=ut,x++}n.sun[d]=Z,d++}else if(N.isDirectionalLight){const Z=t.get(N);if(Z.color.copy(N.color).multiplyScalar(N.intensity),N.castShadow){const Q=N.shadow,it=e.get(N);it.shadowIntensity=Q.intensity,it.shadowBias=Q.bias,it.shadowNormalBias=Q.normalBias,it.shadowRadius=Q.radius,it.shadowMapSize=Q.mapSize,n.directionalShadow[m]=it,n.directionalShadowMap[m]=lt,n.directionalShadowMatrix[m]=N.shadow.matrix,P++}n.directional[m]=Z,m++}else if(N.isSpotLight){const Z=t.get(N);Z.position.setFromMatrixPosition(N.matrixWorld),Z.color.copy(H).multiplyScalar(K),Z.distance=k,Z.coneCos=Math.cos(N.angle),Z.penumbraCos=Math.cos(N.angle*(1-N.penumbra)),Z.decay=N.decay,n.spot[S]=Z;const Q=N.shadow;if(N.map&&(n.spotLightMap[w]=N.map,w++,Q.updateMatrices(N),N.castShadow&&B++),n.spotLightMatrix[S]=Q.matrix,N.castShadow){const it=e.get(N);it.shadowIntensity=Q.intensity,it.shadowBias=Q.bias,it.shadowNormalBias=Q.normalBias,it.shadowRadius=Q.radius,it.shadowMapSize=Q.mapSize,n.spotShadow[S]=it,n.spotShadowMap[S]=lt,_++}S++}else if(N.isRectAreaLight){const Z=t.get(N);Z.color.copy(H).multiplyScalar(K),Z.halfWidth.set(N.width*.5,0,0),Z.halfHeight.set(0,N.height*.5,0),n.rectArea[C]=Z,C++}else if(N.isPointLight){const Z=t.get(N);if(Z.color.copy(N.color).multiplyScalar(N.intensity),Z.distance=N.distance,Z.decay=N.decay,N.castShadow){const Q=N.shadow,it=e.get(N);it.shadowIntensity=Q.intensity,it.shadowBias=Q.bias,it.shadowNormalBias=Q.normalBias,it.shadowRadius=Q.radius,it.shadowMapSize=Q.mapSize,it.shadowCameraNear=Q.camera.near,it.shadowCameraFar=Q.camera.far,n.pointShadow[p]=it,n.pointShadowMap[p]=lt,n.pointShadowMatrix[p]=N.shadow.matrix,T++}n.point[p]=Z,p++}else if(N.isHemisphereLight){const Z=t.get(N);Z.skyColor.copy(N.color).multiplyScalar(K),Z.groundColor.copy(N.groundColor).multiplyScalar(K),n.hemi[b]=Z,b++}}C>0&&(i.has("OES_texture_float_linear")===!0?(n.rectAreaLTC1=Lt.LTC_FLOAT_1,n.rectAreaLTC2=Lt.LTC_FLOAT_2):(n.rectAreaLTC1=Lt.LTC_HALF_1,n.rectAreaLTC2=Lt.LTC_HALF_2)),n.ambient[0]=h,n.ambient[1]=u,n.ambient[2]=f;const D=n.hash;(D.sunLength!==d||D.directionalLength!==m||D.pointLength!==p||D.spotLength!==S||D.rectAreaLength!==C||D.hemiLength!==b||D.numSunShadows!==x||D.numDirectionalShadows!==P||D.numPointShadows!==T||D.numSpotShadows!==_||D.numSpotMaps!==w||D.numLightProbes!==I)&&(n.sun.length=d,n.directional.length=m,n.spot.length=S,n.rectArea.length=C,n.point.length=p,n.hemi.length=b,n.sunShadow.length=x,n.sunShadowMap.length=x,n.sunShadowMatrix.length=v,n.sunShadowCascade.length=v,n.directionalShadow.length=P,n.directionalShadowMap.length=P,n.directionalShadowMatrix.length=P,n.pointShadow.length=T,n.pointShadowMap.length=T,n.pointShadowMatrix.length=T,n.spotShadow.length=_,n.spotShadowMap.length=_,n.spotLightMatrix.length=_+w-B,n.spotLightMap.length=w,n.numSpotLightShadowsWithMaps=B,n.numLightProbes=I,D.sunLength=d,D.directionalLength=m,D.pointLength=p,D.spotLength=S,D.rectAreaLength=C,D.hemiLength=b,D.numSunShadows=x,D.numDirectionalShadows=P,D.numPointShadows=T,D.numSpotShadows=_,D.numSpotMaps=w,D.numLightProbes=I,n.version=oE++)}function l(c,h){let u=0,f=0,d=0,x=0,v=0,m=0;const p=h.matrixWorldInverse;for(let S=0,C=c.length;S<C;S++){const b=c[S];if(b.isSunLight){const P=n.sun[u];P.direction.setFromMatrixPosition(b.matrixWorld),P.direction.transformDirection(p),u++}else if(b.isDirectionalLight){const P=n.directional[f];P.direction.setFromMatrixPosition(b.matrixWorld),s.setFromMatrixPosition(b.target.matrixWorld),P.direction.sub(s),P.direction.transformDirection(p),f++}else if(b.isSpotLight){const P=n.spot[x];P.position.setFromMatrixPosition(b.matrixWorld),P.position.applyMatrix4(p),P.direction.setFromMatrixPosition(b.matrixWorld),s.setFromMatrixPosition(b.target.matrixWorld),P.direction.sub(s),P.direction.transformDirection(p),x++}else if(b.isRectAreaLight){const P=n.rectArea[v];P.position.setFromMatrixPosition(b.matrixWorld),P.position.applyMatrix4(p),a.identity(),r.copy(b.matrixWorld),r.premultiply(p),a.extractRotation(r),P.halfWidth.set(b.width*.5,0,0),P.halfHeight.set(0,b.height*.5,0),P.halfWidth.applyMatrix4(a),P.halfHeight.applyMatrix4(a),v++}else if(b.isPointLight){const P=n.point[d];P.position.setFromMatrixPosition(b.matrixWorld),P.position.applyMatrix4(p),d++}else if(b.isHemisphereLight){const P=n.hemi[m];P.direction.setFromMatrixPosition(b.matrixWorld),P.direction.transformDirection(p),m++}}}return{setup:o,setupView:l,state:n}}function id(i){const t=new cE(i),e=[],n=[],s=[];function r(u){h.camera=u,e.length=0,n.length=0,s.length=0}function a(u){u.isLightProbeGrid?s.push(u):e.push(u)}function o(u){n.push(u)}function l(){t.setup(e),s.sort((u,f)=>u.priority-f.priority||u.id-f.id)}function c(u){t.setupView(e,u)}const h={lightsArray:e,shadowsArray:n,lightProbeGridArray:s,camera:null,lights:t,transmissionRenderTarget:{},textureUnits:0};return{init:r,state:h,setupLights:l,setupLightsView:c,pushLight:a,pushShadow:o}}function hE(i){let t=new WeakMap;function e(s,r=0){const a=t.get(s);let o;return a===void 0?(o=new id(i),t.set(s,[o])):r>=a.length?(o=new id(i),a.push(o)):o=a[r],o}function n(){t=new WeakMap}return{get:e,dispose:n}}const uE=`void main() {
	gl_Position = vec4( position, 1.0 );
}`,fE=`uniform sampler2D shadow_pass;
uniform vec2 resolution;
uniform float radius;
void main() {
	const float samples = float( VSM_SAMPLES );
	float mean = 0.0;
	float squared_mean = 0.0;
	float uvStride = samples <= 1.0 ? 0.0 : 2.0 / ( samples - 1.0 );
	float uvStart = samples <= 1.0 ? 0.0 : - 1.0;
	for ( float i = 0.0; i < samples; i ++ ) {
		float uvOffset = uvStart + i * uvStride;
		#ifdef HORIZONTAL_PASS
			vec2 distribution = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( uvOffset, 0.0 ) * radius ) / resolution ).rg;
			mean += distribution.x;
			squared_mean += distribution.y * distribution.y + distribution.x * distribution.x;
		#else
			float depth = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( 0.0, uvOffset ) * radius ) / resolution ).r;
			mean += depth;
			squared_mean += depth * depth;
		#endif
	}
	mean = mean / samples;
	squared_mean = squared_mean / samples;
	float std_dev = sqrt( max( 0.0, squared_mean - mean * mean ) );
	gl_FragColor = vec4( mean, std_dev, 0.0, 1.0 );
}`,dE=[new W(1,0,0),new W(-1,0,0),new W(0,1,0),new W(0,-1,0),new W(0,0,1),new W(0,0,-1)],pE=[new W(0,-1,0),new W(0,-1,0),new W(0,0,1),new W(0,0,-1),new W(0,-1,0),new W(0,-1,0)],sd=new Pe,aa=new W,ql=new W;function mE(i,t,e){let n=new wa;const s=new ee,r=new ee,a=new je,o=new Ax,l=new Rx,c={},h=e.maxTextureSize,u={[Bs]:Vn,[Vn]:Bs,[Qi]:Qi},f=new Hs({defines:{VSM_SAMPLES:8},uniforms:{shadow_pass:{value:null},resolution:{value:new ee},radius:{value:4}},vertexShader:uE,fragmentShader:fE}),d=f.clone();d.defines.HORIZONTAL_PASS=1;const x=new li;x.setAttribute("position",new Ui(new Float32Array([-1,-1,.5,3,-1,.5,-1,3,.5]),3));const v=new ss(x,f),m=this;this.enabled=!1,this.autoUpdate=!0,this.needsUpdate=!1,this.type=xo;let p=this.type;this.render=function(T,_,w){if(m.enabled===!1||m.autoUpdate===!1&&m.needsUpdate===!1||T.length===0)return;this.type===u0&&(Kt("WebGLShadowMap: PCFSoftShadowMap has been removed. Using PCFShadowMap instead."),this.type=xo);const B=i.getRenderTarget(),I=i.getActiveCubeFace(),D=i.getActiveMipmapLevel(),z=i.state;z.setBlending(Er),z.buffers.depth.getReversed()===!0?z.buffers.color.setClear(0,0,0,0):z.buffers.color.setClear(1,1,1,1),z.buffers.depth.setTest(!0),z.setScissorTest(!1);const V=p!==this.type;V&&_.traverse(function(N){N.material&&(Array.isArray(N.material)?N.material.forEach(H=>H.needsUpdate=!0):N.material.needsUpdate=!0)});for(let N=0,H=T.length;N<H;N++){const K=T[N],k=K.shadow;if(k===void 0){Kt("WebGLShadowMap:",K,"has no shadow.");continue}if(k.autoUpdate===!1&&k.needsUpdate===!1)continue;s.copy(k.mapSize);const lt=k.getFrameExtents();s.multiply(lt),r.copy(k.mapSize),(s.x>h||s.y>h)&&(s.x>h&&(r.x=Math.floor(h/lt.x),s.x=r.x*lt.x,k.mapSize.x=r.x),s.y>h&&(r.y=Math.floor(h/lt.y),s.y=r.y*lt.y,k.mapSize.y=r.y));const Z=i.state.buffers.depth.getReversed();if(k.camera._reversedDepth=Z,k.map===null||V===!0){if(k.map!==null&&(k.map.depthTexture!==null&&(k.map.depthTexture.dispose(),k.map.depthTexture=null),k.map.dispose()),this.type===fa){if(K.isPointLight){Kt("WebGLShadowMap: VSM shadow maps are not supported for PointLights. Use PCF or BasicShadowMap instead.");continue}k.map=new Ii(s.x,s.y,{format:zs,type:Oi,minFilter:Gn,magFilter:Gn,generateMipmaps:!1}),k.map.texture.name=K.name+".shadowMap",k.map.depthTexture=new Dr(s.x,s.y,Mi),k.map.depthTexture.name=K.name+".shadowMapDepth",k.map.depthTexture.format=bs,k.map.depthTexture.compareFunction=null,k.map.depthTexture.minFilter=An,k.map.depthTexture.magFilter=An}else K.isPointLight?(k.map=new Ph(s.x),k.map.depthTexture=new Up(s.x,Fi)):(k.map=new Ii(s.x,s.y),k.map.depthTexture=new Dr(s.x,s.y,Fi)),k.map.depthTexture.name=K.name+".shadowMap",k.map.depthTexture.format=bs,this.type===xo?(k.map.depthTexture.compareFunction=Z?Ep:yp,k.map.depthTexture.minFilter=Gn,k.map.depthTexture.magFilter=Gn):(k.map.depthTexture.compareFunction=null,k.map.depthTexture.minFilter=An,k.map.depthTexture.magFilter=An);k.camera.updateProjectionMatrix()}k.map.isWebGLCubeRenderTarget!==!0&&(k.map.width!==s.x||k.map.height!==s.y)&&k.map.setSize(s.x,s.y);const Q=k.map.isWebGLCubeRenderTarget?6:k.getViewportCount();K.isPointLight!==!0&&k.updateMatrices(K,w);const it=(k.camera.layers.mask&4294967294)!==0?k.camera.layers:w.layers;for(let ut=0;ut<Q;ut++){const ht=k.getCamera(ut);if(K.isPointLight){const j=k.camera,pt=k.matrix,_t=K.distance||j.far;_t!==j.far&&(j.far=_t,j.updateProjectionMatrix()),aa.setFromMatrixPosition(K.matrixWorld),j.position.copy(aa),ql.copy(j.position),ql.add(dE[ut]),j.up.copy(pE[ut]),j.lookAt(ql),j.updateMatrixWorld(),pt.makeTranslation(-aa.x,-aa.y,-aa.z),sd.multiplyMatrices(j.projectionMatrix,j.matrixWorldInverse),k._frustum.setFromProjectionMatrix(sd,j.coordinateSystem,j.reversedDepth)}if(k.map.isWebGLCubeRenderTarget)i.setRenderTarget(k.map,ut),i.clear();else{ut===0&&(i.setRenderTarget(k.map),i.clear());const j=k.getViewport(ut);a.set(r.x*j.x,r.y*j.y,r.x*j.z,r.y*j.w),z.viewport(a)}n=k.getFrustum(ut),b(_,w,ht,K,it,this.type)}k.isPointLightShadow!==!0&&this.type===fa&&S(k,w),k.needsUpdate=!1}p=this.type,m.needsUpdate=!1,i.setRenderTarget(B,I,D)};function S(T,_){const w=t.update(v);f.defines.VSM_SAMPLES!==T.blurSamples&&(f.defines.VSM_SAMPLES=T.blurSamples,d.defines.VSM_SAMPLES=T.blurSamples,f.needsUpdate=!0,d.needsUpdate=!0),T.mapPass===null?T.mapPass=new Ii(s.x,s.y,{format:zs,type:Oi}):(T.mapPass.width!==T.map.width||T.mapPass.height!==T.map.height)&&T.mapPass.setSize(T.map.width,T.map.height),f.uniforms.shadow_pass.value=T.map.depthTexture,f.uniforms.resolution.value.set(T.map.width,T.map.height),f.uniforms.radius.value=T.radius,i.setRenderTarget(T.mapPass),i.clear(),i.renderBufferDirect(_,null,w,f,v,null),d.uniforms.shadow_pass.value=T.mapPass.texture,d.uniforms.resolution.value.set(T.map.width,T.map.height),d.uniforms.radius.value=T.radius,i.setRenderTarget(T.map),i.clear(),i.renderBufferDirect(_,null,w,d,v,null)}function C(T,_,w,B){let I=null;const D=w.isPointLight===!0?T.customDistanceMaterial:T.customDepthMaterial;if(D!==void 0)I=D;else if(I=w.isPointLight===!0?l:o,i.localClippingEnabled&&_.clipShadows===!0&&Array.isArray(_.clippingPlanes)&&_.clippingPlanes.length!==0||_.displacementMap&&_.displacementScale!==0||_.alphaMap&&_.alphaTest>0||_.map&&_.alphaTest>0||_.alphaToCoverage===!0){const z=I.uuid,V=_.uuid;let N=c[z];N===void 0&&(N={},c[z]=N);let H=N[V];H===void 0&&(H=I.clone(),N[V]=H,_.addEventListener("dispose",P)),I=H}if(I.visible=_.visible,I.wireframe=_.wireframe,B===fa?I.side=_.shadowSide!==null?_.shadowSide:_.side:I.side=_.shadowSide!==null?_.shadowSide:u[_.side],I.alphaMap=_.alphaMap,I.alphaTest=_.alphaToCoverage===!0?.5:_.alphaTest,I.map=_.map,I.clipShadows=_.clipShadows,I.clippingPlanes=_.clippingPlanes,I.clipIntersection=_.clipIntersection,I.displacementMap=_.displacementMap,I.displacementScale=_.displacementScale,I.displacementBias=_.displacementBias,I.wireframeLinewidth=_.wireframeLinewidth,I.linewidth=_.linewidth,w.isPointLight===!0&&I.isMeshDistanceMaterial===!0){const z=i.properties.get(I);z.light=w}return I}function b(T,_,w,B,I,D){if(T.visible===!1)return;if(T.layers.test(I)&&(T.isMesh||T.isLine||T.isPoints)&&(T.castShadow||T.receiveShadow&&D===fa)&&(!T.frustumCulled||T.intersectsFrustum(n))){T.modelViewMatrix.multiplyMatrices(w.matrixWorldInverse,T.matrixWorld);const N=t.update(T),H=T.material;if(Array.isArray(H)){const K=N.groups;for(let k=0,lt=K.length;k<lt;k++){const Z=K[k],Q=H[Z.materialIndex];if(Q&&Q.visible){const it=C(T,Q,B,D);T.onBeforeShadow(i,T,_,w,N,it,Z),i.renderBufferDirect(w,null,N,it,T,Z),T.onAfterShadow(i,T,_,w,N,it,Z)}}}else if(H.visible){const K=C(T,H,B,D);T.onBeforeShadow(i,T,_,w,N,K,null),i.renderBufferDirect(w,null,N,K,T,null),T.onAfterShadow(i,T,_,w,N,K,null)}}const V=T.children;for(let N=0,H=V.length;N<H;N++)b(V[N],_,w,B,I,D)}function P(T){T.target.removeEventListener("dispose",P);for(const w in c){const B=c[w],I=T.target.uuid;I in B&&(B[I].dispose(),delete B[I])}}}function gE(i,t){function e(){let U=!1;const st=new je;let et=null;const Et=new je(0,0,0,0);return{setMask:function(mt){et!==mt&&!U&&(i.colorMask(mt,mt,mt,mt),et=mt)},setLocked:function(mt){U=mt},setClear:function(mt,Mt,Ht,Yt,ot){ot===!0&&(mt*=Yt,Mt*=Yt,Ht*=Yt),st.set(mt,Mt,Ht,Yt),Et.equals(st)===!1&&(i.clearColor(mt,Mt,Ht,Yt),Et.copy(st))},reset:function(){U=!1,et=null,Et.set(-1,0,0,0)}}}function n(){let U=!1,st=!1,et=null,Et=null,mt=null;return{setReversed:function(Mt){if(st!==Mt){const Ht=t.get("EXT_clip_control");Mt?Ht.clipControlEXT(Ht.LOWER_LEFT_EXT,Ht.ZERO_TO_ONE_EXT):Ht.clipControlEXT(Ht.LOWER_LEFT_EXT,Ht.NEGATIVE_ONE_TO_ONE_EXT),st=Mt;const Yt=mt;mt=null,this.setClear(Yt)}},getReversed:function(){return st},setTest:function(Mt){Mt?St(i.DEPTH_TEST):Gt(i.DEPTH_TEST)},setMask:function(Mt){et!==Mt&&!U&&(i.depthMask(Mt),et=Mt)},setFunc:function(Mt){if(st&&(Mt=X0[Mt]),Et!==Mt){switch(Mt){case hc:i.depthFunc(i.NEVER);break;case uc:i.depthFunc(i.ALWAYS);break;case fc:i.depthFunc(i.LESS);break;case Sa:i.depthFunc(i.LEQUAL);break;case dc:i.depthFunc(i.EQUAL);break;case pc:i.depthFunc(i.GEQUAL);break;case mc:i.depthFunc(i.GREATER);break;case gc:i.depthFunc(i.NOTEQUAL);break;default:i.depthFunc(i.LEQUAL)}Et=Mt}},setLocked:function(Mt){U=Mt},setClear:function(Mt){mt!==Mt&&(mt=Mt,st&&(Mt=1-Mt),i.clearDepth(Mt))},reset:function(){U=!1,et=null,Et=null,mt=null,st=!1}}}function s(){let U=!1,st=null,et=null,Et=null,mt=null,Mt=null,Ht=null,Yt=null,ot=null;return{setTest:function(Ft){U||(Ft?St(i.STENCIL_TEST):Gt(i.STENCIL_TEST))},setMask:function(Ft){st!==Ft&&!U&&(i.stencilMask(Ft),st=Ft)},setFunc:function(Ft,qt,At){(et!==Ft||Et!==qt||mt!==At)&&(i.stencilFunc(Ft,qt,At),et=Ft,Et=qt,mt=At)},setOp:function(Ft,qt,At){(Mt!==Ft||Ht!==qt||Yt!==At)&&(i.stencilOp(Ft,qt,At),Mt=Ft,Ht=qt,Yt=At)},setLocked:function(Ft){U=Ft},setClear:function(Ft){ot!==Ft&&(i.clearStencil(Ft),ot=Ft)},reset:function(){U=!1,st=null,et=null,Et=null,mt=null,Mt=null,Ht=null,Yt=null,ot=null}}}const r=new e,a=new n,o=new s;let l={};const c=new WeakMap;let h={},u={},f={},d=new WeakMap,x=[],v=null,m=!1,p=null,S=null,C=null,b=null,P=null,T=null,_=null,w=new se(0,0,0),B=0,I=!1,D=null,z=null,V=null,N=null,H=null;const K=i.getParameter(i.MAX_COMBINED_TEXTURE_IMAGE_UNITS);let k=!1,lt=0;const Z=i.getParameter(i.VERSION);Z.indexOf("WebGL")!==-1?(lt=parseFloat(/^WebGL (\d)/.exec(Z)[1]),k=lt>=1):Z.indexOf("OpenGL ES")!==-1&&(lt=parseFloat(/^OpenGL ES (\d)/.exec(Z)[1]),k=lt>=2);let Q=null,it={};const ut=i.getParameter(i.SCISSOR_BOX),ht=i.getParameter(i.VIEWPORT),j=new je().fromArray(ut),pt=new je().fromArray(ht);function _t(U,st,et,Et){const mt=new Uint8Array(4),Mt=i.createTexture();i.bindTexture(U,Mt),i.texParameteri(U,i.TEXTURE_MIN_FILTER,i.NEAREST),i.texParameteri(U,i.TEXTURE_MAG_FILTER,i.NEAREST);for(let Ht=0;Ht<et;Ht++)U===i.TEXTURE_3D||U===i.TEXTURE_2D_ARRAY?i.texImage3D(st,0,i.RGBA,1,1,Et,0,i.RGBA,i.UNSIGNED_BYTE,mt):i.texImage2D(st+Ht,0,i.RGBA,1,1,0,i.RGBA,i.UNSIGNED_BYTE,mt);return Mt}const Tt={};Tt[i.TEXTURE_2D]=_t(i.TEXTURE_2D,i.TEXTURE_2D,1),Tt[i.TEXTURE_CUBE_MAP]=_t(i.TEXTURE_CUBE_MAP,i.TEXTURE_CUBE_MAP_POSITIVE_X,6),Tt[i.TEXTURE_2D_ARRAY]=_t(i.TEXTURE_2D_ARRAY,i.TEXTURE_2D_ARRAY,1,1),Tt[i.TEXTURE_3D]=_t(i.TEXTURE_3D,i.TEXTURE_3D,1,1),r.setClear(0,0,0,1),a.setClear(1),o.setClear(0),St(i.DEPTH_TEST),a.setFunc(Sa),tn(!1),Le(ef),St(i.CULL_FACE),Ge(Er);function St(U){h[U]!==!0&&(i.enable(U),h[U]=!0)}function Gt(U){h[U]!==!1&&(i.disable(U),h[U]=!1)}function jt(U,st){return f[U]!==st?(i.bindFramebuffer(U,st),f[U]=st,U===i.DRAW_FRAMEBUFFER&&(f[i.FRAMEBUFFER]=st),U===i.FRAMEBUFFER&&(f[i.DRAW_FRAMEBUFFER]=st),!0):!1}function zt(U,st){let et=x,Et=!1;if(U){et=d.get(st),et===void 0&&(et=[],d.set(st,et));const mt=U.textures;if(et.length!==mt.length||et[0]!==i.COLOR_ATTACHMENT0){for(let Mt=0,Ht=mt.length;Mt<Ht;Mt++)et[Mt]=i.COLOR_ATTACHMENT0+Mt;et.length=mt.length,Et=!0}}else et[0]!==i.BACK&&(et[0]=i.BACK,Et=!0);Et&&i.drawBuffers(et)}function le(U){return v!==U?(i.useProgram(U),v=U,!0):!1}const re={[gr]:i.FUNC_ADD,[d0]:i.FUNC_SUBTRACT,[p0]:i.FUNC_REVERSE_SUBTRACT};re[m0]=i.MIN,re[g0]=i.MAX;const Jt={[_0]:i.ZERO,[x0]:i.ONE,[v0]:i.SRC_COLOR,[ap]:i.SRC_ALPHA,[w0]:i.SRC_ALPHA_SATURATE,[E0]:i.DST_COLOR,[S0]:i.DST_ALPHA,[M0]:i.ONE_MINUS_SRC_COLOR,[op]:i.ONE_MINUS_SRC_ALPHA,[b0]:i.ONE_MINUS_DST_COLOR,[y0]:i.ONE_MINUS_DST_ALPHA,[T0]:i.CONSTANT_COLOR,[A0]:i.ONE_MINUS_CONSTANT_COLOR,[R0]:i.CONSTANT_ALPHA,[C0]:i.ONE_MINUS_CONSTANT_ALPHA};function Ge(U,st,et,Et,mt,Mt,Ht,Yt,ot,Ft){if(U===Er){m===!0&&(Gt(i.BLEND),m=!1);return}if(m===!1&&(St(i.BLEND),m=!0),U!==f0){if(U!==p||Ft!==I){if((S!==gr||P!==gr)&&(i.blendEquation(i.FUNC_ADD),S=gr,P=gr),Ft)switch(U){case xa:i.blendFuncSeparate(i.ONE,i.ONE_MINUS_SRC_ALPHA,i.ONE,i.ONE_MINUS_SRC_ALPHA);break;case nf:i.blendFunc(i.ONE,i.ONE);break;case sf:i.blendFuncSeparate(i.ZERO,i.ONE_MINUS_SRC_COLOR,i.ZERO,i.ONE);break;case rf:i.blendFuncSeparate(i.DST_COLOR,i.ONE_MINUS_SRC_ALPHA,i.ZERO,i.ONE);break;default:Ee("WebGLState: Invalid blending: ",U);break}else switch(U){case xa:i.blendFuncSeparate(i.SRC_ALPHA,i.ONE_MINUS_SRC_ALPHA,i.ONE,i.ONE_MINUS_SRC_ALPHA);break;case nf:i.blendFuncSeparate(i.SRC_ALPHA,i.ONE,i.ONE,i.ONE);break;case sf:Ee("WebGLState: SubtractiveBlending requires material.premultipliedAlpha = true");break;case rf:Ee("WebGLState: MultiplyBlending requires material.premultipliedAlpha = true");break;default:Ee("WebGLState: Invalid blending: ",U);break}C=null,b=null,T=null,_=null,w.set(0,0,0),B=0,p=U,I=Ft}return}mt=mt||st,Mt=Mt||et,Ht=Ht||Et,(st!==S||mt!==P)&&(i.blendEquationSeparate(re[st],re[mt]),S=st,P=mt),(et!==C||Et!==b||Mt!==T||Ht!==_)&&(i.blendFuncSeparate(Jt[et],Jt[Et],Jt[Mt],Jt[Ht]),C=et,b=Et,T=Mt,_=Ht),(Yt.equals(w)===!1||ot!==B)&&(i.blendColor(Yt.r,Yt.g,Yt.b,ot),w.copy(Yt),B=ot),p=U,I=!1}function Fe(U,st){U.side===Qi?Gt(i.CULL_FACE):St(i.CULL_FACE);let et=U.side===Vn;st&&(et=!et),tn(et),U.blending===xa&&U.transparent===!1?Ge(Er):Ge(U.blending,U.blendEquation,U.blendSrc,U.blendDst,U.blendEquationAlpha,U.blendSrcAlpha,U.blendDstAlpha,U.blendColor,U.blendAlpha,U.premultipliedAlpha),a.setFunc(U.depthFunc),a.setTest(U.depthTest),a.setMask(U.depthWrite),r.setMask(U.colorWrite);const Et=U.stencilWrite;o.setTest(Et),Et&&(o.setMask(U.stencilWriteMask),o.setFunc(U.stencilFunc,U.stencilRef,U.stencilFuncMask),o.setOp(U.stencilFail,U.stencilZFail,U.stencilZPass)),xe(U.polygonOffset,U.polygonOffsetFactor,U.polygonOffsetUnits),U.alphaToCoverage===!0?St(i.SAMPLE_ALPHA_TO_COVERAGE):Gt(i.SAMPLE_ALPHA_TO_COVERAGE)}function tn(U){D!==U&&(U?i.frontFace(i.CW):i.frontFace(i.CCW),D=U)}function Le(U){U!==c0?(St(i.CULL_FACE),U!==z&&(U===ef?i.cullFace(i.BACK):U===h0?i.cullFace(i.FRONT):i.cullFace(i.FRONT_AND_BACK))):Gt(i.CULL_FACE),z=U}function xn(U){U!==V&&(k&&i.lineWidth(U),V=U)}function xe(U,st,et){U?(St(i.POLYGON_OFFSET_FILL),(N!==st||H!==et)&&(N=st,H=et,a.getReversed()&&(st=-st,et=-et),i.polygonOffset(st,et))):Gt(i.POLYGON_OFFSET_FILL)}function hn(U){U?St(i.SCISSOR_TEST):Gt(i.SCISSOR_TEST)}function Xe(U){U===void 0&&(U=i.TEXTURE0+K-1),Q!==U&&(i.activeTexture(U),Q=U)}function en(U,st,et){et===void 0&&(Q===null?et=i.TEXTURE0+K-1:et=Q);let Et=it[et];Et===void 0&&(Et={type:void 0,texture:void 0},it[et]=Et),(Et.type!==U||Et.texture!==st)&&(Q!==et&&(i.activeTexture(et),Q=et),i.bindTexture(U,st||Tt[U]),Et.type=U,Et.texture=st)}function F(){const U=it[Q];U!==void 0&&U.type!==void 0&&(i.bindTexture(U.type,null),U.type=void 0,U.texture=void 0)}function Rt(){try{i.compressedTexImage2D(...arguments)}catch(U){Ee("WebGLState:",U)}}function Xt(){try{i.compressedTexImage3D(...arguments)}catch(U){Ee("WebGLState:",U)}}function te(){try{i.texSubImage2D(...arguments)}catch(U){Ee("WebGLState:",U)}}function yt(){try{i.texSubImage3D(...arguments)}catch(U){Ee("WebGLState:",U)}}function Ne(){try{i.compressedTexSubImage2D(...arguments)}catch(U){Ee("WebGLState:",U)}}function Bt(){try{i.compressedTexSubImage3D(...arguments)}catch(U){Ee("WebGLState:",U)}}function Wt(){try{i.texStorage2D(...arguments)}catch(U){Ee("WebGLState:",U)}}function A(){try{i.texStorage3D(...arguments)}catch(U){Ee("WebGLState:",U)}}function M(){try{i.texImage2D(...arguments)}catch(U){Ee("WebGLState:",U)}}function X(){try{i.texImage3D(...arguments)}catch(U){Ee("WebGLState:",U)}}function ct(U){return u[U]!==void 0?u[U]:i.getParameter(U)}function rt(U,st){u[U]!==st&&(i.pixelStorei(U,st),u[U]=st)}function gt(U){j.equals(U)===!1&&(i.scissor(U.x,U.y,U.z,U.w),j.copy(U))}function xt(U){pt.equals(U)===!1&&(i.viewport(U.x,U.y,U.z,U.w),pt.copy(U))}function tt(U,st){let et=c.get(st);et===void 0&&(et=new WeakMap,c.set(st,et));let Et=et.get(U);Et===void 0&&(Et=i.getUniformBlockIndex(st,U.name),i.uniformBlockBinding(st,Et,Et),et.set(U,Et))}function nt(U,st,et){const mt=c.get(st).get(U);l[mt]!==et&&(i.bindBufferBase(i.UNIFORM_BUFFER,mt,et),l[mt]=et)}function dt(){i.disable(i.BLEND),i.disable(i.CULL_FACE),i.disable(i.DEPTH_TEST),i.disable(i.POLYGON_OFFSET_FILL),i.disable(i.SCISSOR_TEST),i.disable(i.STENCIL_TEST),i.disable(i.SAMPLE_ALPHA_TO_COVERAGE),i.blendEquation(i.FUNC_ADD),i.blendFunc(i.ONE,i.ZERO),i.blendFuncSeparate(i.ONE,i.ZERO,i.ONE,i.ZERO),i.blendColor(0,0,0,0),i.colorMask(!0,!0,!0,!0),i.clearColor(0,0,0,0),i.depthMask(!0),i.depthFunc(i.LESS),a.setReversed(!1),i.clearDepth(1),i.stencilMask(4294967295),i.stencilFunc(i.ALWAYS,0,4294967295),i.stencilOp(i.KEEP,i.KEEP,i.KEEP),i.clearStencil(0),i.cullFace(i.BACK),i.frontFace(i.CCW),i.polygonOffset(0,0),i.activeTexture(i.TEXTURE0),i.bindFramebuffer(i.FRAMEBUFFER,null),i.bindFramebuffer(i.DRAW_FRAMEBUFFER,null),i.bindFramebuffer(i.READ_FRAMEBUFFER,null),i.useProgram(null),i.lineWidth(1),i.scissor(0,0,i.canvas.width,i.canvas.height),i.viewport(0,0,i.canvas.width,i.canvas.height),i.pixelStorei(i.PACK_ALIGNMENT,4),i.pixelStorei(i.UNPACK_ALIGNMENT,4),i.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,!1),i.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,!1),i.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,i.BROWSER_DEFAULT_WEBGL),i.pixelStorei(i.PACK_ROW_LENGTH,0),i.pixelStorei(i.PACK_SKIP_PIXELS,0),i.pixelStorei(i.PACK_SKIP_ROWS,0),i.pixelStorei(i.UNPACK_ROW_LENGTH,0),i.pixelStorei(i.UNPACK_IMAGE_HEIGHT,0),i.pixelStorei(i.UNPACK_SKIP_PIXELS,0),i.pixelStorei(i.UNPACK_SKIP_ROWS,0),i.pixelStorei(i.UNPACK_SKIP_IMAGES,0),h={},u={},Q=null,it={},f={},l={},d=new WeakMap,x=[],v=null,m=!1,p=null,S=null,C=null,b=null,P=null,T=null,_=null,w=new se(0,0,0),B=0,I=!1,D=null,z=null,V=null,N=null,H=null,j.set(0,0,i.canvas.width,i.canvas.height),pt.set(0,0,i.canvas.width,i.canvas.height),r.reset(),a.reset(),o.reset()}return{buffers:{color:r,depth:a,stencil:o},enable:St,disable:Gt,bindFramebuffer:jt,drawBuffers:zt,useProgram:le,setBlending:Ge,setMaterial:Fe,setFlipSided:tn,setCullFace:Le,setLineWidth:xn,setPolygonOffset:xe,setScissorTest:hn,activeTexture:Xe,bindTexture:en,unbindTexture:F,compressedTexImage2D:Rt,compressedTexImage3D:Xt,texImage2D:M,texImage3D:X,pixelStorei:rt,getParameter:ct,updateUBOMapping:tt,uniformBlockBinding:nt,texStorage2D:Wt,texStorage3D:A,texSubImage2D:te,texSubImage3D:yt,compressedTexSubImage2D:Ne,compressedTexSubImage3D:Bt,scissor:gt,viewport:xt,reset:dt}}function _E(i,t,e,n,s,r,a){const o=t.has("WEBGL_multisampled_render_to_texture")?t.get("WEBGL_multisampled_render_to_texture"):null,l=typeof navigator>"u"?!1:/OculusBrowser/g.test(navigator.userAgent),c=new ee,h=new WeakMap,u=new Set;let f;const d=new WeakMap,x=new Set,v=new FinalizationRegistry(A=>x.delete(A));let m=!1;try{m=typeof OffscreenCanvas<"u"&&new OffscreenCanvas(1,1).getContext("2d")!==null}catch{}function p(A,M){return m?new OffscreenCanvas(A,M):Uo("canvas")}function S(A,M,X){let ct=1;const rt=Wt(A);if((rt.width>X||rt.height>X)&&(ct=X/Math.max(rt.width,rt.height)),ct<1)if(typeof HTMLImageElement<"u"&&A instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&A instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&A instanceof ImageBitmap||typeof VideoFrame<"u"&&A instanceof VideoFrame){const gt=Math.floor(ct*rt.width),xt=Math.floor(ct*rt.height);f===void 0&&(f=p(gt,xt));const tt=M?p(gt,xt):f;return tt.width=gt,tt.height=xt,tt.getContext("2d").drawImage(A,0,0,gt,xt),Kt("WebGLRenderer: Texture has been resized from ("+rt.width+"x"+rt.height+") to ("+gt+"x"+xt+")."),tt}else return"data"in A&&Kt("WebGLRenderer: Image in DataTexture is too big ("+rt.width+"x"+rt.height+")."),A;return A}function C(A){return A.generateMipmaps}function b(A){i.generateMipmap(A)}function P(A){return A.isWebGLCubeRenderTarget?i.TEXTURE_CUBE_MAP:A.isWebGL3DRenderTarget?i.TEXTURE_3D:A.isWebGLArrayRenderTarget||A.isCompressedArrayTexture?i.TEXTURE_2D_ARRAY:i.TEXTURE_2D}function T(A,M,X,ct,rt,gt=!1){if(A!==null){if(i[A]!==void 0)return i[A];Kt("WebGLRenderer: Attempt to use non-existing WebGL internal format '"+A+"'")}let xt;ct&&(xt=t.get("EXT_texture_norm16"),xt||Kt("WebGLRenderer: Unable to use normalized textures without EXT_texture_norm16 extension"));let tt=M;if(M===i.RED&&(X===i.FLOAT&&(tt=i.R32F),X===i.HALF_FLOAT&&(tt=i.R16F),X===i.UNSIGNED_BYTE&&(tt=i.R8),X===i.UNSIGNED_SHORT&&xt&&(tt=xt.R16_EXT),X===i.SHORT&&xt&&(tt=xt.R16_SNORM_EXT)),M===i.RED_INTEGER&&(X===i.UNSIGNED_BYTE&&(tt=i.R8UI),X===i.UNSIGNED_SHORT&&(tt=i.R16UI),X===i.UNSIGNED_INT&&(tt=i.R32UI),X===i.BYTE&&(tt=i.R8I),X===i.SHORT&&(tt=i.R16I),X===i.INT&&(tt=i.R32I)),M===i.RG&&(X===i.FLOAT&&(tt=i.RG32F),X===i.HALF_FLOAT&&(tt=i.RG16F),X===i.UNSIGNED_BYTE&&(tt=i.RG8),X===i.UNSIGNED_SHORT&&xt&&(tt=xt.RG16_EXT),X===i.SHORT&&xt&&(tt=xt.RG16_SNORM_EXT)),M===i.RG_INTEGER&&(X===i.UNSIGNED_BYTE&&(tt=i.RG8UI),X===i.UNSIGNED_SHORT&&(tt=i.RG16UI),X===i.UNSIGNED_INT&&(tt=i.RG32UI),X===i.BYTE&&(tt=i.RG8I),X===i.SHORT&&(tt=i.RG16I),X===i.INT&&(tt=i.RG32I)),M===i.RGB_INTEGER&&(X===i.UNSIGNED_BYTE&&(tt=i.RGB8UI),X===i.UNSIGNED_SHORT&&(tt=i.RGB16UI),X===i.UNSIGNED_INT&&(tt=i.RGB32UI),X===i.BYTE&&(tt=i.RGB8I),X===i.SHORT&&(tt=i.RGB16I),X===i.INT&&(tt=i.RGB32I)),M===i.RGBA_INTEGER&&(X===i.UNSIGNED_BYTE&&(tt=i.RGBA8UI),X===i.UNSIGNED_SHORT&&(tt=i.RGBA16UI),X===i.UNSIGNED_INT&&(tt=i.RGBA32UI),X===i.BYTE&&(tt=i.RGBA8I),X===i.SHORT&&(tt=i.RGBA16I),X===i.INT&&(tt=i.RGBA32I)),M===i.RGB&&(X===i.UNSIGNED_SHORT&&xt&&(tt=xt.RGB16_EXT),X===i.SHORT&&xt&&(tt=xt.RGB16_SNORM_EXT),X===i.UNSIGNED_INT_5_9_9_9_REV&&(tt=i.RGB9_E5),X===i.UNSIGNED_INT_10F_11F_11F_REV&&(tt=i.R11F_G11F_B10F)),M===i.RGBA){const nt=gt?No:_e.getTransfer(rt);X===i.FLOAT&&(tt=i.RGBA32F),X===i.HALF_FLOAT&&(tt=i.RGBA16F),X===i.UNSIGNED_BYTE&&(tt=nt===Ce?i.SRGB8_ALPHA8:i.RGBA8),X===i.UNSIGNED_SHORT&&xt&&(tt=xt.RGBA16_EXT),X===i.SHORT&&xt&&(tt=xt.RGBA16_SNORM_EXT),X===i.UNSIGNED_SHORT_4_4_4_4&&(tt=i.RGBA4),X===i.UNSIGNED_SHORT_5_5_5_1&&(tt=i.RGB5_A1)}return(tt===i.R16F||tt===i.R32F||tt===i.RG16F||tt===i.RG32F||tt===i.RGBA16F||tt===i.RGBA32F)&&t.get("EXT_color_buffer_float"),tt}function _(A,M){let X;return A?M===null||M===Fi||M===Lr?X=i.DEPTH24_STENCIL8:M===Mi?X=i.DEPTH32F_STENCIL8:M===Ea&&(X=i.DEPTH24_STENCIL8,Kt("DepthTexture: 16 bit depth attachment is not supported with stencil. Using 24-bit attachment.")):M===null||M===Fi||M===Lr?X=i.DEPTH_COMPONENT24:M===Mi?X=i.DEPTH_COMPONENT32F:M===Ea&&(X=i.DEPTH_COMPONENT16),X}function w(A,M){return C(A)===!0||A.isFramebufferTexture&&A.minFilter!==An&&A.minFilter!==Gn?Math.log2(Math.max(M.width,M.height))+1:A.mipmaps.length>0?A.mipmaps.length:A.isCompressedTexture&&Array.isArray(A.image)?M.mipmaps.length:1}function B(A){const M=new WeakRef(A);n.get(A).__ref=M,x.add(M),v.register(A,M,M)}function I(A){const M=n.get(A).__ref;M!==void 0&&(x.delete(M),v.unregister(M))}function D(A){V(A.target)}function z(A){N(A.target)}function V(A){A.removeEventListener("dispose",D),I(A),K(A),A.isVideoTexture&&h.delete(A),A.isHTMLTexture&&u.delete(A)}function N(A){A.removeEventListener("dispose",z),I(A),lt(A)}function H(){for(const A of x){const M=A.deref();M!==void 0&&(M.isRenderTarget===!0?N(M):V(M))}x.clear(),u.clear()}function K(A){const M=n.get(A);if(M.__webglInit===void 0)return;const X=A.source,ct=d.get(X);if(ct){const rt=ct[M.__cacheKey];rt.usedTimes--,rt.usedTimes===0&&k(A),Object.keys(ct).length===0&&d.delete(X)}n.remove(A)}function k(A){const M=n.get(A);i.deleteTexture(M.__webglTexture);const X=A.source,ct=d.get(X);delete ct[M.__cacheKey],a.memory.textures--}function lt(A){const M=n.get(A);M.__depthDisposeCallback&&M.__depthDisposeCallback();const X=A.depthTexture;if(X&&X.renderTarget===A&&V(X),A.isWebGLCubeRenderTarget)for(let rt=0;rt<6;rt++){if(Array.isArray(M.__webglFramebuffer[rt]))for(let gt=0;gt<M.__webglFramebuffer[rt].length;gt++)i.deleteFramebuffer(M.__webglFramebuffer[rt][gt]);else i.deleteFramebuffer(M.__webglFramebuffer[rt]);M.__webglDepthbuffer&&i.deleteRenderbuffer(M.__webglDepthbuffer[rt])}else{if(Array.isArray(M.__webglFramebuffer))for(let rt=0;rt<M.__webglFramebuffer.length;rt++)i.deleteFramebuffer(M.__webglFramebuffer[rt]);else i.deleteFramebuffer(M.__webglFramebuffer);if(M.__webglDepthbuffer&&i.deleteRenderbuffer(M.__webglDepthbuffer),M.__webglMultisampledFramebuffer&&i.deleteFramebuffer(M.__webglMultisampledFramebuffer),M.__webglColorRenderbuffer)for(let rt=0;rt<M.__webglColorRenderbuffer.length;rt++)M.__webglColorRenderbuffer[rt]&&i.deleteRenderbuffer(M.__webglColorRenderbuffer[rt]);M.__webglDepthRenderbuffer&&i.deleteRenderbuffer(M.__webglDepthRenderbuffer)}const ct=A.textures;for(let rt=0,gt=ct.length;rt<gt;rt++){const xt=n.get(ct[rt]);xt.__webglTexture&&(i.deleteTexture(xt.__webglTexture),a.memory.textures--),n.remove(ct[rt])}n.remove(A)}let Z=0;function Q(){Z=0}function it(){return Z}function ut(A){Z=A}function ht(){const A=Z;return A>=s.maxTextures&&Kt("WebGLTextures: Trying to use "+(A+1)+" texture units while this GPU supports only "+s.maxTextures),Z+=1,A}function j(A){const M=[];return M.push(A.wrapS),M.push(A.wrapT),M.push(A.wrapR||0),M.push(A.magFilter),M.push(A.minFilter),M.push(A.anisotropy),M.push(A.internalFormat),M.push(A.format),M.push(A.type),M.push(A.generateMipmaps),M.push(A.mipmapsAutoUpdate),M.push(A.premultiplyAlpha),M.push(A.flipY),M.push(A.unpackAlignment),M.push(A.colorSpace),M.join()}function pt(A,M){const X=n.get(A);if(A.isVideoTexture&&Ne(A),A.isRenderTargetTexture===!1&&A.isExternalTexture!==!0&&A.version>0&&X.__version!==A.version){const ct=A.image;if(ct===null)Kt("WebGLRenderer: Texture marked for update but no image data found.");else if(ct.complete===!1)Kt("WebGLRenderer: Texture marked for update but image is incomplete");else{Fe(X,A,M);return}}else A.isExternalTexture&&(X.__webglTexture=A.sourceTexture?A.sourceTexture:null);e.bindTexture(i.TEXTURE_2D,X.__webglTexture,i.TEXTURE0+M)}function _t(A,M){const X=n.get(A);if(A.isRenderTargetTexture===!1&&A.version>0&&X.__version!==A.version){Fe(X,A,M);return}else A.isExternalTexture&&(X.__webglTexture=A.sourceTexture?A.sourceTexture:null);e.bindTexture(i.TEXTURE_2D_ARRAY,X.__webglTexture,i.TEXTURE0+M)}function Tt(A,M){const X=n.get(A);if(A.isRenderTargetTexture===!1&&A.version>0&&X.__version!==A.version){Fe(X,A,M);return}e.bindTexture(i.TEXTURE_3D,X.__webglTexture,i.TEXTURE0+M)}function St(A,M){const X=n.get(A);if(A.version>0&&X.__version!==A.version){tn(X,A,M);return}e.bindTexture(i.TEXTURE_CUBE_MAP,X.__webglTexture,i.TEXTURE0+M)}const Gt={[_c]:i.REPEAT,[ji]:i.CLAMP_TO_EDGE,[xc]:i.MIRRORED_REPEAT},jt={[An]:i.NEAREST,[D0]:i.NEAREST_MIPMAP_NEAREST,[za]:i.NEAREST_MIPMAP_LINEAR,[Gn]:i.LINEAR,[yl]:i.LINEAR_MIPMAP_NEAREST,[Ss]:i.LINEAR_MIPMAP_LINEAR},zt={[F0]:i.NEVER,[bp]:i.ALWAYS,[O0]:i.LESS,[yp]:i.LEQUAL,[k0]:i.EQUAL,[Ep]:i.GEQUAL,[B0]:i.GREATER,[z0]:i.NOTEQUAL};function le(A,M){if(M.type===Mi&&t.has("OES_texture_float_linear")===!1&&(M.magFilter===Gn||M.magFilter===yl||M.magFilter===za||M.magFilter===Ss||M.minFilter===Gn||M.minFilter===yl||M.minFilter===za||M.minFilter===Ss)&&Kt("WebGLRenderer: Unable to use linear filtering with floating point textures. OES_texture_float_linear not supported on this device."),i.texParameteri(A,i.TEXTURE_WRAP_S,Gt[M.wrapS]),i.texParameteri(A,i.TEXTURE_WRAP_T,Gt[M.wrapT]),(A===i.TEXTURE_3D||A===i.TEXTURE_2D_ARRAY)&&i.texParameteri(A,i.TEXTURE_WRAP_R,Gt[M.wrapR]),i.texParameteri(A,i.TEXTURE_MAG_FILTER,jt[M.magFilter]),i.texParameteri(A,i.TEXTURE_MIN_FILTER,jt[M.minFilter]),M.compareFunction&&(i.texParameteri(A,i.TEXTURE_COMPARE_MODE,i.COMPARE_REF_TO_TEXTURE),i.texParameteri(A,i.TEXTURE_COMPARE_FUNC,zt[M.compareFunction])),t.has("EXT_texture_filter_anisotropic")===!0){if(M.magFilter===An||M.minFilter!==za&&M.minFilter!==Ss||M.type===Mi&&t.has("OES_texture_float_linear")===!1)return;if(M.anisotropy>1||n.get(M).__currentAnisotropy){const X=t.get("EXT_texture_filter_anisotropic");i.texParameterf(A,X.TEXTURE_MAX_ANISOTROPY_EXT,Math.min(M.anisotropy,s.getMaxAnisotropy())),n.get(M).__currentAnisotropy=M.anisotropy}}}function re(A,M){let X=!1;A.__webglInit===void 0&&(A.__webglInit=!0,M.addEventListener("dispose",D),B(M));const ct=M.source;let rt=d.get(ct);rt===void 0&&(rt={},d.set(ct,rt));const gt=j(M);if(gt!==A.__cacheKey){rt[gt]===void 0&&(rt[gt]={texture:i.createTexture(),usedTimes:0},a.memory.textures++,X=!0),rt[gt].usedTimes++;const xt=rt[A.__cacheKey];xt!==void 0&&(rt[A.__cacheKey].usedTimes--,xt.usedTimes===0&&k(M)),A.__cacheKey=gt,A.__webglTexture=rt[gt].texture}return X}function Jt(A,M,X){return Math.floor(Math.floor(A/X)/M)}function Ge(A,M,X,ct){const gt=A.updateRanges;if(gt.length===0)e.texSubImage2D(i.TEXTURE_2D,0,0,0,M.width,M.height,X,ct,M.data);else{gt.sort((U,st)=>U.start-st.start);let xt=0;for(let U=1;U<gt.length;U++){const st=gt[xt],et=gt[U],Et=st.start+st.count,mt=Jt(et.start,M.width,4),Mt=Jt(st.start,M.width,4);et.start<=Et+1&&mt===Mt&&Jt(et.start+et.count-1,M.width,4)===mt?st.count=Math.max(st.count,et.start+et.count-st.start):(++xt,gt[xt]=et)}gt.length=xt+1;const tt=e.getParameter(i.UNPACK_ROW_LENGTH),nt=e.getParameter(i.UNPACK_SKIP_PIXELS),dt=e.getParameter(i.UNPACK_SKIP_ROWS);e.pixelStorei(i.UNPACK_ROW_LENGTH,M.width);for(let U=0,st=gt.length;U<st;U++){const et=gt[U],Et=Math.floor(et.start/4),mt=Math.ceil(et.count/4),Mt=Et%M.width,Ht=Math.floor(Et/M.width),Yt=mt,ot=1;e.pixelStorei(i.UNPACK_SKIP_PIXELS,Mt),e.pixelStorei(i.UNPACK_SKIP_ROWS,Ht),e.texSubImage2D(i.TEXTURE_2D,0,Mt,Ht,Yt,ot,X,ct,M.data)}A.clearUpdateRanges(),e.pixelStorei(i.UNPACK_ROW_LENGTH,tt),e.pixelStorei(i.UNPACK_SKIP_PIXELS,nt),e.pixelStorei(i.UNPACK_SKIP_ROWS,dt)}}function Fe(A,M,X){let ct=i.TEXTURE_2D;(M.isDataArrayTexture||M.isCompressedArrayTexture)&&(ct=i.TEXTURE_2D_ARRAY),M.isData3DTexture&&(ct=i.TEXTURE_3D);const rt=re(A,M),gt=M.source;e.bindTexture(ct,A.__webglTexture,i.TEXTURE0+X);const xt=n.get(gt);if(gt.version!==xt.__version||rt===!0){if(e.activeTexture(i.TEXTURE0+X),(typeof ImageBitmap<"u"&&M.image instanceof ImageBitmap)===!1){const ot=_e.getPrimaries(_e.workingColorSpace),Ft=M.colorSpace===Ms?null:_e.getPrimaries(M.colorSpace),qt=M.colorSpace===Ms||ot===Ft?i.NONE:i.BROWSER_DEFAULT_WEBGL;e.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,M.flipY),e.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,M.premultiplyAlpha),e.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,qt)}e.pixelStorei(i.UNPACK_ALIGNMENT,M.unpackAlignment);let nt=S(M.image,!1,s.maxTextureSize);nt=Bt(M,nt);const dt=r.convert(M.format,M.colorSpace),U=r.convert(M.type);let st=T(M.internalFormat,dt,U,M.normalized,M.colorSpace,M.isVideoTexture);le(ct,M);let et;const Et=M.mipmaps,mt=M.isVideoTexture!==!0,Mt=xt.__version===void 0||rt===!0,Ht=gt.dataReady,Yt=w(M,nt);if(M.isDepthTexture)st=_(M.format===ys,M.type),Mt&&(mt?e.texStorage2D(i.TEXTURE_2D,1,st,nt.width,nt.height):e.texImage2D(i.TEXTURE_2D,0,st,nt.width,nt.height,0,dt,U,null));else if(M.isDataTexture)if(Et.length>0){mt&&Mt&&e.texStorage2D(i.TEXTURE_2D,Yt,st,Et[0].width,Et[0].height);for(let ot=0,Ft=Et.length;ot<Ft;ot++)et=Et[ot],mt?Ht&&e.texSubImage2D(i.TEXTURE_2D,ot,0,0,et.width,et.height,dt,U,et.data):e.texImage2D(i.TEXTURE_2D,ot,st,et.width,et.height,0,dt,U,et.data);M.generateMipmaps=!1}else mt?(Mt&&e.texStorage2D(i.TEXTURE_2D,Yt,st,nt.width,nt.height),Ht&&Ge(M,nt,dt,U)):e.texImage2D(i.TEXTURE_2D,0,st,nt.width,nt.height,0,dt,U,nt.data);else if(M.isCompressedTexture)if(M.isCompressedArrayTexture){mt&&Mt&&e.texStorage3D(i.TEXTURE_2D_ARRAY,Yt,st,Et[0].width,Et[0].height,nt.depth);for(let ot=0,Ft=Et.length;ot<Ft;ot++)if(et=Et[ot],M.format!==Ni)if(dt!==null)if(mt){if(Ht)if(M.layerUpdates.size>0){const qt=Of(et.width,et.height,M.format,M.type);for(const At of M.layerUpdates){const ie=et.data.subarray(At*qt/et.data.BYTES_PER_ELEMENT,(At+1)*qt/et.data.BYTES_PER_ELEMENT);e.compressedTexSubImage3D(i.TEXTURE_2D_ARRAY,ot,0,0,At,et.width,et.height,1,dt,ie)}}else e.compressedTexSubImage3D(i.TEXTURE_2D_ARRAY,ot,0,0,0,et.width,et.height,nt.depth,dt,et.data)}else e.compressedTexImage3D(i.TEXTURE_2D_ARRAY,ot,st,et.width,et.height,nt.depth,0,et.data,0,0);else Kt("WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()");else mt?Ht&&e.texSubImage3D(i.TEXTURE_2D_ARRAY,ot,0,0,0,et.width,et.height,nt.depth,dt,U,et.data):e.texImage3D(i.TEXTURE_2D_ARRAY,ot,st,et.width,et.height,nt.depth,0,dt,U,et.data);M.layerUpdates.size>0&&M.clearLayerUpdates()}else{mt&&Mt&&e.texStorage2D(i.TEXTURE_2D,Yt,st,Et[0].width,Et[0].height);for(let ot=0,Ft=Et.length;ot<Ft;ot++)et=Et[ot],M.format!==Ni?dt!==null?mt?Ht&&e.compressedTexSubImage2D(i.TEXTURE_2D,ot,0,0,et.width,et.height,dt,et.data):e.compressedTexImage2D(i.TEXTURE_2D,ot,st,et.width,et.height,0,et.data):Kt("WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()"):mt?Ht&&e.texSubImage2D(i.TEXTURE_2D,ot,0,0,et.width,et.height,dt,U,et.data):e.texImage2D(i.TEXTURE_2D,ot,st,et.width,et.height,0,dt,U,et.data)}else if(M.isDataArrayTexture)if(mt){if(Mt&&e.texStorage3D(i.TEXTURE_2D_ARRAY,Yt,st,nt.width,nt.height,nt.depth),Ht)if(M.layerUpdates.size>0){const ot=Of(nt.width,nt.height,M.format,M.type);for(const Ft of M.layerUpdates){const qt=nt.data.subarray(Ft*ot/nt.data.BYTES_PER_ELEMENT,(Ft+1)*ot/nt.data.BYTES_PER_ELEMENT);e.texSubImage3D(i.TEXTURE_2D_ARRAY,0,0,0,Ft,nt.width,nt.height,1,dt,U,qt)}M.clearLayerUpdates()}else e.texSubImage3D(i.TEXTURE_2D_ARRAY,0,0,0,0,nt.width,nt.height,nt.depth,dt,U,nt.data)}else e.texImage3D(i.TEXTURE_2D_ARRAY,0,st,nt.width,nt.height,nt.depth,0,dt,U,nt.data);else if(M.isData3DTexture)mt?(Mt&&e.texStorage3D(i.TEXTURE_3D,Yt,st,nt.width,nt.height,nt.depth),Ht&&e.texSubImage3D(i.TEXTURE_3D,0,0,0,0,nt.width,nt.height,nt.depth,dt,U,nt.data)):e.texImage3D(i.TEXTURE_3D,0,st,nt.width,nt.height,nt.depth,0,dt,U,nt.data);else if(M.isFramebufferTexture){if(Mt)if(mt)e.texStorage2D(i.TEXTURE_2D,Yt,st,nt.width,nt.height);else{let ot=nt.width,Ft=nt.height;for(let qt=0;qt<Yt;qt++)e.texImage2D(i.TEXTURE_2D,qt,st,ot,Ft,0,dt,U,null),ot>>=1,Ft>>=1}}else if(M.isHTMLTexture){if("texElementImage2D"in i){const ot=i.canvas;if(ot.hasAttribute("layoutsubtree")||ot.setAttribute("layoutsubtree","true"),nt.parentNode!==ot){ot.appendChild(nt),u.add(M),ot.onpaint=Ft=>{const qt=Ft.changedElements;for(const At of u)qt.includes(At.image)&&(At.needsUpdate=!0)},ot.requestPaint();return}if(i.texElementImage2D.length===3)i.texElementImage2D(i.TEXTURE_2D,i.RGBA8,nt);else{const qt=i.RGBA,At=i.RGBA,ie=i.UNSIGNED_BYTE;i.texElementImage2D(i.TEXTURE_2D,0,qt,At,ie,nt)}i.texParameteri(i.TEXTURE_2D,i.TEXTURE_MIN_FILTER,i.LINEAR),i.texParameteri(i.TEXTURE_2D,i.TEXTURE_WRAP_S,i.CLAMP_TO_EDGE),i.texParameteri(i.TEXTURE_2D,i.TEXTURE_WRAP_T,i.CLAMP_TO_EDGE)}}else if(Et.length>0){if(mt&&Mt){const ot=Wt(Et[0]);e.texStorage2D(i.TEXTURE_2D,Yt,st,ot.width,ot.height)}for(let ot=0,Ft=Et.length;ot<Ft;ot++)et=Et[ot],mt?Ht&&e.texSubImage2D(i.TEXTURE_2D,ot,0,0,dt,U,et):e.texImage2D(i.TEXTURE_2D,ot,st,dt,U,et);M.generateMipmaps=!1}else if(mt){if(Mt){const ot=Wt(nt);e.texStorage2D(i.TEXTURE_2D,Yt,st,ot.width,ot.height)}Ht&&e.texSubImage2D(i.TEXTURE_2D,0,0,0,dt,U,nt)}else e.texImage2D(i.TEXTURE_2D,0,st,dt,U,nt);C(M)&&M.mipmapsAutoUpdate===!0&&b(ct),xt.__version=gt.version,M.onUpdate&&M.onUpdate(M)}A.__version=M.version}function tn(A,M,X){if(M.image.length!==6)return;const ct=re(A,M),rt=M.source;e.bindTexture(i.TEXTURE_CUBE_MAP,A.__webglTexture,i.TEXTURE0+X);const gt=n.get(rt);if(rt.version!==gt.__version||ct===!0){e.activeTexture(i.TEXTURE0+X);const xt=_e.getPrimaries(_e.workingColorSpace),tt=M.colorSpace===Ms?null:_e.getPrimaries(M.colorSpace),nt=M.colorSpace===Ms||xt===tt?i.NONE:i.BROWSER_DEFAULT_WEBGL;e.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,M.flipY),e.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,M.premultiplyAlpha),e.pixelStorei(i.UNPACK_ALIGNMENT,M.unpackAlignment),e.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,nt);const dt=M.isCompressedTexture||M.image[0].isCompressedTexture,U=M.image[0]&&M.image[0].isDataTexture,st=[];for(let At=0;At<6;At++)!dt&&!U?st[At]=S(M.image[At],!0,s.maxCubemapSize):st[At]=U?M.image[At].image:M.image[At],st[At]=Bt(M,st[At]);const et=st[0],Et=r.convert(M.format,M.colorSpace),mt=r.convert(M.type);let Mt=T(M.internalFormat,Et,mt,M.normalized,M.colorSpace);const Ht=M.isVideoTexture!==!0,Yt=gt.__version===void 0||ct===!0,ot=rt.dataReady;let Ft=w(M,et);le(i.TEXTURE_CUBE_MAP,M);let qt;if(M.isDepthTexture){if(Mt=_(M.format===ys,M.type),Yt)if(Ht)e.texStorage2D(i.TEXTURE_CUBE_MAP,1,Mt,et.width,et.height);else for(let At=0;At<6;At++)e.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+At,0,Mt,et.width,et.height,0,Et,mt,null)}else if(dt){Ht&&Yt&&e.texStorage2D(i.TEXTURE_CUBE_MAP,Ft,Mt,et.width,et.height);for(let At=0;At<6;At++){qt=st[At].mipmaps;for(let ie=0;ie<qt.length;ie++){const Oe=qt[ie];M.format!==Ni?Et!==null?Ht?ot&&e.compressedTexSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+At,ie,0,0,Oe.width,Oe.height,Et,Oe.data):e.compressedTexImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+At,ie,Mt,Oe.width,Oe.height,0,Oe.data):Kt("WebGLRenderer: Attempt to load unsupported compressed texture format in .setTextureCube()"):Ht?ot&&e.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+At,ie,0,0,Oe.width,Oe.height,Et,mt,Oe.data):e.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+At,ie,Mt,Oe.width,Oe.height,0,Et,mt,Oe.data)}}}else{if(qt=M.mipmaps,Ht&&Yt){qt.length>0&&Ft++;const At=Wt(st[0]);e.texStorage2D(i.TEXTURE_CUBE_MAP,Ft,Mt,At.width,At.height)}for(let At=0;At<6;At++)if(U){Ht?ot&&e.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+At,0,0,0,st[At].width,st[At].height,Et,mt,st[At].data):e.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+At,0,Mt,st[At].width,st[At].height,0,Et,mt,st[At].data);for(let ie=0;ie<qt.length;ie++){const Dn=qt[ie].image[At].image;Ht?ot&&e.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+At,ie+1,0,0,Dn.width,Dn.height,Et,mt,Dn.data):e.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+At,ie+1,Mt,Dn.width,Dn.height,0,Et,mt,Dn.data)}}else{Ht?ot&&e.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+At,0,0,0,Et,mt,st[At]):e.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+At,0,Mt,Et,mt,st[At]);for(let ie=0;ie<qt.length;ie++){const Oe=qt[ie];Ht?ot&&e.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+At,ie+1,0,0,Et,mt,Oe.image[At]):e.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+At,ie+1,Mt,Et,mt,Oe.image[At])}}}C(M)&&M.mipmapsAutoUpdate===!0&&b(i.TEXTURE_CUBE_MAP),gt.__version=rt.version,M.onUpdate&&M.onUpdate(M)}A.__version=M.version}function Le(A,M,X,ct,rt,gt){const xt=r.convert(X.format,X.colorSpace),tt=r.convert(X.type),nt=T(X.internalFormat,xt,tt,X.normalized,X.colorSpace),dt=n.get(M),U=n.get(X);if(U.__renderTarget=M,!dt.__hasExternalTextures){const st=Math.max(1,M.width>>gt),et=Math.max(1,M.height>>gt);rt===i.TEXTURE_3D||rt===i.TEXTURE_2D_ARRAY?e.texImage3D(rt,gt,nt,st,et,M.depth,0,xt,tt,null):e.texImage2D(rt,gt,nt,st,et,0,xt,tt,null)}e.bindFramebuffer(i.FRAMEBUFFER,A),yt(M)?o.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,ct,rt,U.__webglTexture,0,te(M)):(rt===i.TEXTURE_2D||rt>=i.TEXTURE_CUBE_MAP_POSITIVE_X&&rt<=i.TEXTURE_CUBE_MAP_NEGATIVE_Z)&&i.framebufferTexture2D(i.FRAMEBUFFER,ct,rt,U.__webglTexture,gt),e.bindFramebuffer(i.FRAMEBUFFER,null)}function xn(A,M,X){if(i.bindRenderbuffer(i.RENDERBUFFER,A),M.depthBuffer){const ct=M.depthTexture,rt=ct&&ct.isDepthTexture?ct.type:null,gt=_(M.stencilBuffer,rt),xt=M.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;yt(M)?o.renderbufferStorageMultisampleEXT(i.RENDERBUFFER,te(M),gt,M.width,M.height):X?i.renderbufferStorageMultisample(i.RENDERBUFFER,te(M),gt,M.width,M.height):i.renderbufferStorage(i.RENDERBUFFER,gt,M.width,M.height),i.framebufferRenderbuffer(i.FRAMEBUFFER,xt,i.RENDERBUFFER,A)}else{const ct=M.textures;for(let rt=0;rt<ct.length;rt++){const gt=ct[rt],xt=r.convert(gt.format,gt.colorSpace),tt=r.convert(gt.type),nt=T(gt.internalFormat,xt,tt,gt.normalized,gt.colorSpace);yt(M)?o.renderbufferStorageMultisampleEXT(i.RENDERBUFFER,te(M),nt,M.width,M.height):X?i.renderbufferStorageMultisample(i.RENDERBUFFER,te(M),nt,M.width,M.height):i.renderbufferStorage(i.RENDERBUFFER,nt,M.width,M.height)}}i.bindRenderbuffer(i.RENDERBUFFER,null)}function xe(A,M,X){const ct=M.isWebGLCubeRenderTarget===!0;if(e.bindFramebuffer(i.FRAMEBUFFER,A),!(M.depthTexture&&M.depthTexture.isDepthTexture))throw new Error("THREE.WebGLTextures: renderTarget.depthTexture must be an instance of THREE.DepthTexture.");const rt=n.get(M.depthTexture);rt.__renderTarget=M;const gt=ct?M.depthTexture.image[0]:M.depthTexture.image;(!rt.__webglTexture||gt.width!==M.width||gt.height!==M.height)&&(gt.width=M.width,gt.height=M.height,M.depthTexture.needsUpdate=!0),ct?St(M.depthTexture,0):pt(M.depthTexture,0);const xt=rt.__webglTexture,tt=te(M),nt=ct?i.TEXTURE_CUBE_MAP_POSITIVE_X+X:i.TEXTURE_2D,dt=M.depthTexture.format===ys?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;if(M.depthTexture.format===bs)yt(M)?o.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,dt,nt,xt,0,tt):i.framebufferTexture2D(i.FRAMEBUFFER,dt,nt,xt,0);else if(M.depthTexture.format===ys)yt(M)?o.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,dt,nt,xt,0,tt):i.framebufferTexture2D(i.FRAMEBUFFER,dt,nt,xt,0);else throw new Error("THREE.WebGLTextures: Unknown depthTexture format.")}function hn(A){const M=n.get(A),X=A.isWebGLCubeRenderTarget===!0;if(M.__boundDepthTexture!==A.depthTexture){const ct=A.depthTexture;if(M.__depthDisposeCallback&&M.__depthDisposeCallback(),ct){const rt=()=>{delete M.__boundDepthTexture,delete M.__depthDisposeCallback,ct.removeEventListener("dispose",rt)};ct.addEventListener("dispose",rt),M.__depthDisposeCallback=rt}M.__boundDepthTexture=ct}if(A.depthTexture&&!M.__autoAllocateDepthBuffer)if(X)for(let ct=0;ct<6;ct++)xe(M.__webglFramebuffer[ct],A,ct);else A.texture.mipmaps.length>0?xe(M.__webglFramebuffer[0],A,0):xe(M.__webglFramebuffer,A,0);else if(X){M.__webglDepthbuffer=[];for(let ct=0;ct<6;ct++)if(e.bindFramebuffer(i.FRAMEBUFFER,M.__webglFramebuffer[ct]),M.__webglDepthbuffer[ct]===void 0)M.__webglDepthbuffer[ct]=i.createRenderbuffer(),xn(M.__webglDepthbuffer[ct],A,!1);else{const rt=A.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,gt=M.__webglDepthbuffer[ct];i.bindRenderbuffer(i.RENDERBUFFER,gt),i.framebufferRenderbuffer(i.FRAMEBUFFER,rt,i.RENDERBUFFER,gt)}}else if(A.texture.mipmaps.length>0?e.bindFramebuffer(i.FRAMEBUFFER,M.__webglFramebuffer[0]):e.bindFramebuffer(i.FRAMEBUFFER,M.__webglFramebuffer),M.__webglDepthbuffer===void 0)M.__webglDepthbuffer=i.createRenderbuffer(),xn(M.__webglDepthbuffer,A,!1);else{const rt=A.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,gt=M.__webglDepthbuffer;i.bindRenderbuffer(i.RENDERBUFFER,gt),i.framebufferRenderbuffer(i.FRAMEBUFFER,rt,i.RENDERBUFFER,gt)}e.bindFramebuffer(i.FRAMEBUFFER,null)}function Xe(A,M,X){const ct=n.get(A);M!==void 0&&Le(ct.__webglFramebuffer,A,A.texture,i.COLOR_ATTACHMENT0,i.TEXTURE_2D,0),X!==void 0&&hn(A)}function en(A){const M=A.texture,X=n.get(A),ct=n.get(M);A.addEventListener("dispose",z),B(A);const rt=A.textures,gt=A.isWebGLCubeRenderTarget===!0,xt=rt.length>1;if(xt||(ct.__webglTexture===void 0&&(ct.__webglTexture=i.createTexture()),ct.__version=M.version,a.memory.textures++),gt){X.__webglFramebuffer=[];for(let tt=0;tt<6;tt++)if(M.mipmaps.length>0){X.__webglFramebuffer[tt]=[];for(let nt=0;nt<M.mipmaps.length;nt++)X.__webglFramebuffer[tt][nt]=i.createFramebuffer()}else X.__webglFramebuffer[tt]=i.createFramebuffer()}else{if(M.mipmaps.length>0){X.__webglFramebuffer=[];for(let tt=0;tt<M.mipmaps.length;tt++)X.__webglFramebuffer[tt]=i.createFramebuffer()}else X.__webglFramebuffer=i.createFramebuffer();if(xt)for(let tt=0,nt=rt.length;tt<nt;tt++){const dt=n.get(rt[tt]);dt.__webglTexture===void 0&&(dt.__webglTexture=i.createTexture(),a.memory.textures++)}if(A.samples>0&&yt(A)===!1){X.__webglMultisampledFramebuffer=i.createFramebuffer(),X.__webglColorRenderbuffer=[],e.bindFramebuffer(i.FRAMEBUFFER,X.__webglMultisampledFramebuffer);for(let tt=0;tt<rt.length;tt++){const nt=rt[tt];X.__webglColorRenderbuffer[tt]=i.createRenderbuffer(),i.bindRenderbuffer(i.RENDERBUFFER,X.__webglColorRenderbuffer[tt]);const dt=r.convert(nt.format,nt.colorSpace),U=r.convert(nt.type),st=T(nt.internalFormat,dt,U,nt.normalized,nt.colorSpace,A.isXRRenderTarget===!0),et=te(A);i.renderbufferStorageMultisample(i.RENDERBUFFER,et,st,A.width,A.height),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+tt,i.RENDERBUFFER,X.__webglColorRenderbuffer[tt])}i.bindRenderbuffer(i.RENDERBUFFER,null),A.depthBuffer&&(X.__webglDepthRenderbuffer=i.createRenderbuffer(),xn(X.__webglDepthRenderbuffer,A,!0)),e.bindFramebuffer(i.FRAMEBUFFER,null)}}if(gt){e.bindTexture(i.TEXTURE_CUBE_MAP,ct.__webglTexture),le(i.TEXTURE_CUBE_MAP,M);for(let tt=0;tt<6;tt++)if(M.mipmaps.length>0)for(let nt=0;nt<M.mipmaps.length;nt++)Le(X.__webglFramebuffer[tt][nt],A,M,i.COLOR_ATTACHMENT0,i.TEXTURE_CUBE_MAP_POSITIVE_X+tt,nt);else Le(X.__webglFramebuffer[tt],A,M,i.COLOR_ATTACHMENT0,i.TEXTURE_CUBE_MAP_POSITIVE_X+tt,0);C(M)?b(i.TEXTURE_CUBE_MAP):M.mipmaps.length>0&&i.texParameteri(i.TEXTURE_CUBE_MAP,i.TEXTURE_MAX_LEVEL,M.mipmaps.length-1),e.unbindTexture()}else if(xt){for(let tt=0,nt=rt.length;tt<nt;tt++){const dt=rt[tt],U=n.get(dt);let st=i.TEXTURE_2D;(A.isWebGL3DRenderTarget||A.isWebGLArrayRenderTarget)&&(st=A.isWebGL3DRenderTarget?i.TEXTURE_3D:i.TEXTURE_2D_ARRAY),e.bindTexture(st,U.__webglTexture),le(st,dt),Le(X.__webglFramebuffer,A,dt,i.COLOR_ATTACHMENT0+tt,st,0),C(dt)&&b(st)}e.unbindTexture()}else{let tt=i.TEXTURE_2D;if((A.isWebGL3DRenderTarget||A.isWebGLArrayRenderTarget)&&(tt=A.isWebGL3DRenderTarget?i.TEXTURE_3D:i.TEXTURE_2D_ARRAY),e.bindTexture(tt,ct.__webglTexture),le(tt,M),M.mipmaps.length>0)for(let nt=0;nt<M.mipmaps.length;nt++)Le(X.__webglFramebuffer[nt],A,M,i.COLOR_ATTACHMENT0,tt,nt);else Le(X.__webglFramebuffer,A,M,i.COLOR_ATTACHMENT0,tt,0);C(M)?b(tt):M.mipmaps.length>0&&i.texParameteri(tt,i.TEXTURE_MAX_LEVEL,M.mipmaps.length-1),e.unbindTexture()}A.depthBuffer&&hn(A)}function F(A){const M=A.textures;for(let X=0,ct=M.length;X<ct;X++){const rt=M[X];if(C(rt)&&rt.mipmapsAutoUpdate===!0){const gt=P(A),xt=n.get(rt).__webglTexture;e.bindTexture(gt,xt),b(gt),e.unbindTexture()}}}const Rt=[];function Xt(A){if(A.samples>0){if(yt(A)===!1){const M=A.textures,X=A.width,ct=A.height;let rt=i.COLOR_BUFFER_BIT;const gt=A.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,xt=n.get(A),tt=M.length>1;if(tt)for(let dt=0;dt<M.length;dt++)e.bindFramebuffer(i.FRAMEBUFFER,xt.__webglMultisampledFramebuffer),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+dt,i.RENDERBUFFER,null),e.bindFramebuffer(i.FRAMEBUFFER,xt.__webglFramebuffer),i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0+dt,i.TEXTURE_2D,null,0);e.bindFramebuffer(i.READ_FRAMEBUFFER,xt.__webglMultisampledFramebuffer),A.texture.mipmaps.length>0?e.bindFramebuffer(i.DRAW_FRAMEBUFFER,xt.__webglFramebuffer[0]):e.bindFramebuffer(i.DRAW_FRAMEBUFFER,xt.__webglFramebuffer);for(let dt=0;dt<M.length;dt++){if(A.resolveDepthBuffer&&(A.depthBuffer&&(rt|=i.DEPTH_BUFFER_BIT),A.stencilBuffer&&A.resolveStencilBuffer&&(rt|=i.STENCIL_BUFFER_BIT)),tt){i.framebufferRenderbuffer(i.READ_FRAMEBUFFER,i.COLOR_ATTACHMENT0,i.RENDERBUFFER,xt.__webglColorRenderbuffer[dt]);const U=n.get(M[dt]).__webglTexture;i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0,i.TEXTURE_2D,U,0)}i.blitFramebuffer(0,0,X,ct,0,0,X,ct,rt,i.NEAREST),l===!0&&(Rt.length=0,Rt.push(i.COLOR_ATTACHMENT0+dt),A.depthBuffer&&A.storeMultisampledDepthBuffer===!1&&Rt.push(gt),i.invalidateFramebuffer(i.READ_FRAMEBUFFER,Rt))}if(e.bindFramebuffer(i.READ_FRAMEBUFFER,null),e.bindFramebuffer(i.DRAW_FRAMEBUFFER,null),tt)for(let dt=0;dt<M.length;dt++){e.bindFramebuffer(i.FRAMEBUFFER,xt.__webglMultisampledFramebuffer),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+dt,i.RENDERBUFFER,xt.__webglColorRenderbuffer[dt]);const U=n.get(M[dt]).__webglTexture;e.bindFramebuffer(i.FRAMEBUFFER,xt.__webglFramebuffer),i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0+dt,i.TEXTURE_2D,U,0)}e.bindFramebuffer(i.DRAW_FRAMEBUFFER,xt.__webglMultisampledFramebuffer)}else if(A.depthBuffer&&A.storeMultisampledDepthBuffer===!1&&l){const M=A.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;i.invalidateFramebuffer(i.DRAW_FRAMEBUFFER,[M])}}}function te(A){return Math.min(s.maxSamples,A.samples)}function yt(A){const M=n.get(A);return A.samples>0&&t.has("WEBGL_multisampled_render_to_texture")===!0&&M.__useRenderToTexture!==!1}function Ne(A){const M=a.render.frame;h.get(A)!==M&&(h.set(A,M),A.update())}function Bt(A,M){const X=A.colorSpace,ct=A.format,rt=A.type;return A.isCompressedTexture===!0||A.isVideoTexture===!0||X!==Do&&X!==Ms&&(_e.getTransfer(X)===Ce?(ct!==Ni||rt!==jn)&&Kt("WebGLTextures: sRGB encoded textures have to use RGBAFormat and UnsignedByteType."):Ee("WebGLTextures: Unsupported texture color space:",X)),M}function Wt(A){return typeof HTMLImageElement<"u"&&A instanceof HTMLImageElement?(c.width=A.naturalWidth||A.width,c.height=A.naturalHeight||A.height):typeof VideoFrame<"u"&&A instanceof VideoFrame?(c.width=A.displayWidth,c.height=A.displayHeight):(c.width=A.width,c.height=A.height),c}this.allocateTextureUnit=ht,this.resetTextureUnits=Q,this.getTextureUnits=it,this.setTextureUnits=ut,this.setTexture2D=pt,this.setTexture2DArray=_t,this.setTexture3D=Tt,this.setTextureCube=St,this.rebindTextures=Xe,this.setupRenderTarget=en,this.updateRenderTargetMipmap=F,this.updateMultisampleRenderTarget=Xt,this.setupDepthRenderbuffer=hn,this.setupFrameBufferTexture=Le,this.useMultisampledRTT=yt,this.dispose=H}function xE(i,t){function e(n,s=Ms){let r;const a=_e.getTransfer(s);if(n===jn)return i.UNSIGNED_BYTE;if(n===_h)return i.UNSIGNED_SHORT_4_4_4_4;if(n===xh)return i.UNSIGNED_SHORT_5_5_5_1;if(n===xp)return i.UNSIGNED_INT_5_9_9_9_REV;if(n===vp)return i.UNSIGNED_INT_10F_11F_11F_REV;if(n===gp)return i.BYTE;if(n===_p)return i.SHORT;if(n===Ea)return i.UNSIGNED_SHORT;if(n===gh)return i.INT;if(n===Fi)return i.UNSIGNED_INT;if(n===Mi)return i.FLOAT;if(n===Oi)return i.HALF_FLOAT;if(n===Mp)return i.ALPHA;if(n===Sp)return i.RGB;if(n===Ni)return i.RGBA;if(n===bs)return i.DEPTH_COMPONENT;if(n===ys)return i.DEPTH_STENCIL;if(n===vh)return i.RED;if(n===Mh)return i.RED_INTEGER;if(n===zs)return i.RG;if(n===Sh)return i.RG_INTEGER;if(n===yh)return i.RGBA_INTEGER;if(n===vo||n===Mo||n===So||n===yo)if(a===Ce)if(r=t.get("WEBGL_compressed_texture_s3tc_srgb"),r!==null){if(n===vo)return r.COMPRESSED_SRGB_S3TC_DXT1_EXT;if(n===Mo)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT;if(n===So)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT;if(n===yo)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT}else return null;else if(r=t.get("WEBGL_compressed_texture_s3tc"),r!==null){if(n===vo)return r.COMPRESSED_RGB_S3TC_DXT1_EXT;if(n===Mo)return r.COMPRESSED_RGBA_S3TC_DXT1_EXT;if(n===So)return r.COMPRESSED_RGBA_S3TC_DXT3_EXT;if(n===yo)return r.COMPRESSED_RGBA_S3TC_DXT5_EXT}else return null;if(n===vc||n===Mc||n===Sc||n===yc)if(r=t.get("WEBGL_compressed_texture_pvrtc"),r!==null){if(n===vc)return r.COMPRESSED_RGB_PVRTC_4BPPV1_IMG;if(n===Mc)return r.COMPRESSED_RGB_PVRTC_2BPPV1_IMG;if(n===Sc)return r.COMPRESSED_RGBA_PVRTC_4BPPV1_IMG;if(n===yc)return r.COMPRESSED_RGBA_PVRTC_2BPPV1_IMG}else return null;if(n===Ec||n===bc||n===wc||n===Tc||n===Ac||n===Po||n===Rc)if(r=t.get("WEBGL_compressed_texture_etc"),r!==null){if(n===Ec||n===bc)return a===Ce?r.COMPRESSED_SRGB8_ETC2:r.COMPRESSED_RGB8_ETC2;if(n===wc)return a===Ce?r.COMPRESSED_SRGB8_ALPHA8_ETC2_EAC:r.COMPRESSED_RGBA8_ETC2_EAC;if(n===Tc)return r.COMPRESSED_R11_EAC;if(n===Ac)return r.COMPRESSED_SIGNED_R11_EAC;if(n===Po)return r.COMPRESSED_RG11_EAC;if(n===Rc)return r.COMPRESSED_SIGNED_RG11_EAC}else return null;if(n===Cc||n===Pc||n===Lc||n===Dc||n===Nc||n===Ic||n===Uc||n===Fc||n===Oc||n===kc||n===Bc||n===zc||n===Hc||n===Gc)if(r=t.get("WEBGL_compressed_texture_astc"),r!==null){if(n===Cc)return a===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_4x4_KHR:r.COMPRESSED_RGBA_ASTC_4x4_KHR;if(n===Pc)return a===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_5x4_KHR:r.COMPRESSED_RGBA_ASTC_5x4_KHR;if(n===Lc)return a===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_5x5_KHR:r.COMPRESSED_RGBA_ASTC_5x5_KHR;if(n===Dc)return a===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_6x5_KHR:r.COMPRESSED_RGBA_ASTC_6x5_KHR;if(n===Nc)return a===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_6x6_KHR:r.COMPRESSED_RGBA_ASTC_6x6_KHR;if(n===Ic)return a===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x5_KHR:r.COMPRESSED_RGBA_ASTC_8x5_KHR;if(n===Uc)return a===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x6_KHR:r.COMPRESSED_RGBA_ASTC_8x6_KHR;if(n===Fc)return a===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x8_KHR:r.COMPRESSED_RGBA_ASTC_8x8_KHR;if(n===Oc)return a===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x5_KHR:r.COMPRESSED_RGBA_ASTC_10x5_KHR;if(n===kc)return a===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x6_KHR:r.COMPRESSED_RGBA_ASTC_10x6_KHR;if(n===Bc)return a===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x8_KHR:r.COMPRESSED_RGBA_ASTC_10x8_KHR;if(n===zc)return a===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x10_KHR:r.COMPRESSED_RGBA_ASTC_10x10_KHR;if(n===Hc)return a===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_12x10_KHR:r.COMPRESSED_RGBA_ASTC_12x10_KHR;if(n===Gc)return a===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_12x12_KHR:r.COMPRESSED_RGBA_ASTC_12x12_KHR}else return null;if(n===Vc||n===Wc||n===Xc)if(r=t.get("EXT_texture_compression_bptc"),r!==null){if(n===Vc)return a===Ce?r.COMPRESSED_SRGB_ALPHA_BPTC_UNORM_EXT:r.COMPRESSED_RGBA_BPTC_UNORM_EXT;if(n===Wc)return r.COMPRESSED_RGB_BPTC_SIGNED_FLOAT_EXT;if(n===Xc)return r.COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT_EXT}else return null;if(n===$c||n===Yc||n===Lo||n===qc)if(r=t.get("EXT_texture_compression_rgtc"),r!==null){if(n===$c)return r.COMPRESSED_RED_RGTC1_EXT;if(n===Yc)return r.COMPRESSED_SIGNED_RED_RGTC1_EXT;if(n===Lo)return r.COMPRESSED_RED_GREEN_RGTC2_EXT;if(n===qc)return r.COMPRESSED_SIGNED_RED_GREEN_RGTC2_EXT}else return null;return n===Lr?i.UNSIGNED_INT_24_8:i[n]!==void 0?i[n]:null}return{convert:e}}const vE=`
void main() {

	gl_Position = vec4( position, 1.0 );

}`,ME=`
uniform sampler2DArray depthColor;
uniform float depthWidth;
uniform float depthHeight;

void main() {

	vec2 coord = vec2( gl_FragCoord.x / depthWidth, gl_FragCoord.y / depthHeight );

	if ( coord.x >= 1.0 ) {

		gl_FragDepth = texture( depthColor, vec3( coord.x - 1.0, coord.y, 1 ) ).r;

	} else {

		gl_FragDepth = texture( depthColor, vec3( coord.x, coord.y, 0 ) ).r;

	}

}`;class SE{constructor(){this.texture=null,this.mesh=null,this.depthNear=0,this.depthFar=0}init(t,e){if(this.texture===null){const n=new Fp(t.texture);(t.depthNear!==e.depthNear||t.depthFar!==e.depthFar)&&(this.depthNear=t.depthNear,this.depthFar=t.depthFar),this.texture=n}}getMesh(t){if(this.texture!==null&&this.mesh===null){const e=t.cameras[0].viewport,n=new Hs({vertexShader:vE,fragmentShader:ME,uniforms:{depthColor:{value:this.texture},depthWidth:{value:e.z},depthHeight:{value:e.w}}});this.mesh=new ss(new Yo(20,20),n)}return this.mesh}reset(){this.texture=null,this.mesh=null}getDepthTexture(){return this.texture}}class yE extends Ts{constructor(t,e){super();const n=this;let s=null,r=1,a=null,o="local-floor",l=1,c=null,h=null,u=null,f=null,d=null,x=null;const v=typeof XRWebGLBinding<"u",m=new SE,p={},S=e.getContextAttributes();let C=null,b=null;const P=[],T=[],_=new ee;let w=null,B=null;const I=new _i;I.viewport=new je;const D=new _i;D.viewport=new je;const z=[I,D],V=new Nx;let N=null,H=null;this.cameraAutoUpdate=!0,this.enabled=!1,this.isPresenting=!1,this.getController=function(j){let pt=P[j];return pt===void 0&&(pt=new Pl,P[j]=pt),pt.getTargetRaySpace()},this.getControllerGrip=function(j){let pt=P[j];return pt===void 0&&(pt=new Pl,P[j]=pt),pt.getGripSpace()},this.getHand=function(j){let pt=P[j];return pt===void 0&&(pt=new Pl,P[j]=pt),pt.getHandSpace()};function K(j){const pt=T.indexOf(j.inputSource);if(pt===-1)return;const _t=P[pt];_t!==void 0&&(_t.update(j.inputSource,j.frame,c||a),_t.dispatchEvent({type:j.type,data:j.inputSource}))}function k(){s.removeEventListener("select",K),s.removeEventListener("selectstart",K),s.removeEventListener("selectend",K),s.removeEventListener("squeeze",K),s.removeEventListener("squeezestart",K),s.removeEventListener("squeezeend",K),s.removeEventListener("end",k),s.removeEventListener("inputsourceschange",lt);for(let j=0;j<P.length;j++){const pt=T[j];pt!==null&&(T[j]=null,P[j].disconnect(pt))}N=null,H=null,m.reset();for(const j in p)delete p[j];if(t.setRenderTarget(C),d=null,f=null,u=null,s=null,b=null,ht.stop(),n.isPresenting=!1,t.setPixelRatio(w),t.setSize(_.width,_.height,!1),B!==null){const j=B.camera;j.fov=B.fov,j.zoom=B.zoom,j.updateProjectionMatrix(),B=null}n.dispatchEvent({type:"sessionend"})}this.setFramebufferScaleFactor=function(j){r=j,n.isPresenting===!0&&Kt("WebXRManager: Cannot change framebuffer scale while presenting.")},this.setReferenceSpaceType=function(j){o=j,n.isPresenting===!0&&Kt("WebXRManager: Cannot change reference space type while presenting.")},this.getReferenceSpace=function(){return c||a},this.setReferenceSpace=function(j){c=j},this.getBaseLayer=function(){return f!==null?f:d},this.getBinding=function(){return u===null&&v&&(u=new XRWebGLBinding(s,e)),u},this.getFrame=function(){return x},this.getSession=function(){return s},this.setSession=async function(j){if(s=j,s!==null){if(C=t.getRenderTarget(),s.addEventListener("select",K),s.addEventListener("selectstart",K),s.addEventListener("selectend",K),s.addEventListener("squeeze",K),s.addEventListener("squeezestart",K),s.addEventListener("squeezeend",K),s.addEventListener("end",k),s.addEventListener("inputsourceschange",lt),S.xrCompatible!==!0&&await e.makeXRCompatible(),w=t.getPixelRatio(),t.getSize(_),v&&"createProjectionLayer"in XRWebGLBinding.prototype){let _t=null,Tt=null,St=null;S.depth&&(St=S.stencil?e.DEPTH24_STENCIL8:e.DEPTH_COMPONENT24,_t=S.stencil?ys:bs,Tt=S.stencil?Lr:Fi);const Gt={colorFormat:e.RGBA8,depthFormat:St,scaleFactor:r};u=this.getBinding(),f=u.createProjectionLayer(Gt),s.updateRenderState({layers:[f]}),t.setPixelRatio(1),t.setSize(f.textureWidth,f.textureHeight,!1),b=new Ii(f.textureWidth,f.textureHeight,{format:Ni,type:jn,depthTexture:new Dr(f.textureWidth,f.textureHeight,Tt,void 0,void 0,void 0,void 0,void 0,void 0,_t),stencilBuffer:S.stencil,colorSpace:t.outputColorSpace,samples:S.antialias?4:0,resolveDepthBuffer:f.ignoreDepthValues===!1,resolveStencilBuffer:f.ignoreDepthValues===!1,storeMultisampledDepthBuffer:f.ignoreDepthValues===!1,storeMultisampledStencilBuffer:f.ignoreDepthValues===!1})}else{const _t={antialias:S.antialias,alpha:!0,depth:S.depth,stencil:S.stencil,framebufferScaleFactor:r};d=new XRWebGLLayer(s,e,_t),s.updateRenderState({baseLayer:d}),t.setPixelRatio(1),t.setSize(d.framebufferWidth,d.framebufferHeight,!1),b=new Ii(d.framebufferWidth,d.framebufferHeight,{format:Ni,type:jn,colorSpace:t.outputColorSpace,stencilBuffer:S.stencil,resolveDepthBuffer:d.ignoreDepthValues===!1,resolveStencilBuffer:d.ignoreDepthValues===!1,storeMultisampledDepthBuffer:d.ignoreDepthValues===!1,storeMultisampledStencilBuffer:d.ignoreDepthValues===!1})}b.isXRRenderTarget=!0,this.setFoveation(l),c=null,a=await s.requestReferenceSpace(o),ht.setContext(s),ht.start(),n.isPresenting=!0,n.dispatchEvent({type:"sessionstart"})}},this.getEnvironmentBlendMode=function(){if(s!==null)return s.environmentBlendMode},this.getDepthTexture=function(){return m.getDepthTexture()};function lt(j){for(let pt=0;pt<j.removed.length;pt++){const _t=j.removed[pt],Tt=T.indexOf(_t);Tt>=0&&(T[Tt]=null,P[Tt].disconnect(_t))}for(let pt=0;pt<j.added.length;pt++){const _t=j.added[pt];let Tt=T.indexOf(_t);if(Tt===-1){for(let Gt=0;Gt<P.length;Gt++)if(Gt>=T.length){T.push(_t),Tt=Gt;break}else if(T[Gt]===null){T[Gt]=_t,Tt=Gt;break}if(Tt===-1)break}const St=P[Tt];St&&St.connect(_t)}}function Z(j,pt){pt===null?j.matrixWorld.copy(j.matrix):j.matrixWorld.multiplyMatrices(pt.matrixWorld,j.matrix),j.matrixWorldInverse.copy(j.matrixWorld).invert()}this.updateCamera=function(j){if(s===null)return;let pt=j.near,_t=j.far;m.texture!==null&&(m.depthNear>0&&(pt=m.depthNear),m.depthFar>0&&(_t=m.depthFar)),V.near=D.near=I.near=pt,V.far=D.far=I.far=_t,(N!==V.near||H!==V.far)&&(s.updateRenderState({depthNear:V.near,depthFar:V.far}),N=V.near,H=V.far),V.layers.mask=j.layers.mask|6,I.layers.mask=V.layers.mask&-5,D.layers.mask=V.layers.mask&-3;const Tt=j.parent,St=V.cameras;Z(V,Tt);for(let Gt=0;Gt<St.length;Gt++)Z(St[Gt],Tt);V.projectionMatrix.copy(I.projectionMatrix),V.projectionMatrixInverse.copy(I.projectionMatrixInverse),B===null&&j.isPerspectiveCamera&&(B={camera:j,fov:j.fov,zoom:j.zoom}),Q(j,V,Tt)};function Q(j,pt,_t){_t===null?j.matrix.copy(pt.matrixWorld):(j.matrix.copy(_t.matrixWorld),j.matrix.invert(),j.matrix.multiply(pt.matrixWorld)),j.matrix.decompose(j.position,j.quaternion,j.scale),j.updateMatrixWorld(!0),j.projectionMatrix.copy(pt.projectionMatrix),j.projectionMatrixInverse.copy(pt.projectionMatrixInverse),j.isPerspectiveCamera&&(j.fov=Zc*2*Math.atan(1/j.projectionMatrix.elements[5]),j.zoom=1)}this.getCamera=function(){return V},this.getFoveation=function(){if(!(f===null&&d===null))return l},this.setFoveation=function(j){l=j,f!==null&&(f.fixedFoveation=j),d!==null&&d.fixedFoveation!==void 0&&(d.fixedFoveation=j)},this.hasDepthSensing=function(){return m.texture!==null},this.getDepthSensingMesh=function(){return m.getMesh(V)},this.getCameraTexture=function(j){return p[j]};let it=null;function ut(j,pt){if(h=pt.getViewerPose(c||a),x=pt,h!==null){const _t=h.views;d!==null&&(t.setRenderTargetFramebuffer(b,d.framebuffer),t.setRenderTarget(b));let Tt=!1;_t.length!==V.cameras.length&&(V.cameras.length=0,Tt=!0);for(let zt=0;zt<_t.length;zt++){const le=_t[zt];let re=null;if(d!==null)re=d.getViewport(le);else{const Ge=u.getViewSubImage(f,le);re=Ge.viewport,zt===0&&(t.setRenderTargetTextures(b,Ge.colorTexture,Ge.depthStencilTexture),t.setRenderTarget(b))}let Jt=z[zt];Jt===void 0&&(Jt=new _i,Jt.layers.enable(zt),Jt.viewport=new je,z[zt]=Jt),Jt.matrix.fromArray(le.transform.matrix),Jt.matrix.decompose(Jt.position,Jt.quaternion,Jt.scale),Jt.projectionMatrix.fromArray(le.projectionMatrix),Jt.projectionMatrixInverse.copy(Jt.projectionMatrix).invert(),Jt.viewport.set(re.x,re.y,re.width,re.height),zt===0&&(V.matrix.copy(Jt.matrix),V.matrix.decompose(V.position,V.quaternion,V.scale)),Tt===!0&&V.cameras.push(Jt)}const St=s.enabledFeatures;if(St&&St.includes("depth-sensing")&&s.depthUsage=="gpu-optimized"&&v){u=n.getBinding();const zt=u.getDepthInformation(_t[0]);zt&&zt.isValid&&zt.texture&&m.init(zt,s.renderState)}if(St&&St.includes("camera-access")&&v){t.state.unbindTexture(),u=n.getBinding();for(let zt=0;zt<_t.length;zt++){const le=_t[zt].camera;if(le){let re=p[le];re||(re=new Fp,p[le]=re);const Jt=u.getCameraImage(le);re.sourceTexture=Jt}}}}for(let _t=0;_t<P.length;_t++){const Tt=T[_t],St=P[_t];Tt!==null&&St!==void 0&&St.update(Tt,pt,c||a)}it&&it(j,pt),pt.detectedPlanes&&n.dispatchEvent({type:"planesdetected",data:pt}),x=null}const ht=new Gp;ht.setAnimationLoop(ut),this.setAnimationLoop=function(j){it=j},this.dispose=function(){}}}const EE=new Pe,Qp=new ne;Qp.set(-1,0,0,0,1,0,0,0,1);function bE(i,t){function e(m,p){m.matrixAutoUpdate===!0&&m.updateMatrix(),p.value.copy(m.matrix)}function n(m,p){p.color.getRGB(m.fogColor.value,Op(i)),p.isFog?(m.fogNear.value=p.near,m.fogFar.value=p.far):p.isFogExp2&&(m.fogDensity.value=p.density)}function s(m,p,S,C,b){p.isNodeMaterial?p.uniformsNeedUpdate=!1:p.isMeshBasicMaterial?r(m,p):p.isMeshLambertMaterial?(r(m,p),p.envMap&&(m.envMapIntensity.value=p.envMapIntensity)):p.isMeshToonMaterial?(r(m,p),u(m,p)):p.isMeshPhongMaterial?(r(m,p),h(m,p),p.envMap&&(m.envMapIntensity.value=p.envMapIntensity)):p.isMeshStandardMaterial?(r(m,p),f(m,p),p.isMeshPhysicalMaterial&&d(m,p,b)):p.isMeshMatcapMaterial?(r(m,p),x(m,p)):p.isMeshDepthMaterial?r(m,p):p.isMeshDistanceMaterial?(r(m,p),v(m,p)):p.isMeshNormalMaterial?r(m,p):p.isLineBasicMaterial?(a(m,p),p.isLineDashedMaterial&&o(m,p)):p.isPointsMaterial?l(m,p,S,C):p.isSpriteMaterial?c(m,p):p.isShadowMaterial?(m.color.value.copy(p.color),m.opacity.value=p.opacity):p.isShaderMaterial&&(p.uniformsNeedUpdate=!1)}function r(m,p){m.opacity.value=p.opacity,p.color&&m.diffuse.value.copy(p.color),p.emissive&&m.emissive.value.copy(p.emissive).multiplyScalar(p.emissiveIntensity),p.map&&(m.map.value=p.map,e(p.map,m.mapTransform)),p.alphaMap&&(m.alphaMap.value=p.alphaMap,e(p.alphaMap,m.alphaMapTransform)),p.bumpMap&&(m.bumpMap.value=p.bumpMap,e(p.bumpMap,m.bumpMapTransform),m.bumpScale.value=p.bumpScale,p.side===Vn&&(m.bumpScale.value*=-1)),p.normalMap&&(m.normalMap.value=p.normalMap,e(p.normalMap,m.normalMapTransform),m.normalScale.value.copy(p.normalScale),p.side===Vn&&m.normalScale.value.negate()),p.displacementMap&&(m.displacementMap.value=p.displacementMap,e(p.displacementMap,m.displacementMapTransform),m.displacementScale.value=p.displacementScale,m.displacementBias.value=p.displacementBias),p.emissiveMap&&(m.emissiveMap.value=p.emissiveMap,e(p.emissiveMap,m.emissiveMapTransform)),p.specularMap&&(m.specularMap.value=p.specularMap,e(p.specularMap,m.specularMapTransform)),p.alphaTest>0&&(m.alphaTest.value=p.alphaTest);const S=t.get(p),C=S.envMap,b=S.envMapRotation;C&&(m.envMap.value=C,m.envMapRotation.value.setFromMatrix4(EE.makeRotationFromEuler(b)).transpose(),C.isCubeTexture&&C.isRenderTargetTexture===!1&&m.envMapRotation.value.premultiply(Qp),m.reflectivity.value=p.reflectivity,m.ior.value=p.ior,m.refractionRatio.value=p.refractionRatio),p.lightMap&&(m.lightMap.value=p.lightMap,m.lightMapIntensity.value=p.lightMapIntensity,e(p.lightMap,m.lightMapTransform)),p.aoMap&&(m.aoMap.value=p.aoMap,m.aoMapIntensity.value=p.aoMapIntensity,e(p.aoMap,m.aoMapTransform))}function a(m,p){m.diffuse.value.copy(p.color),m.opacity.value=p.opacity,p.map&&(m.map.value=p.map,e(p.map,m.mapTransform))}function o(m,p){m.dashSize.value=p.dashSize,m.totalSize.value=p.dashSize+p.gapSize,m.scale.value=p.scale}function l(m,p,S,C){m.diffuse.value.copy(p.color),m.opacity.value=p.opacity,m.size.value=p.size*S,m.scale.value=C*.5,p.map&&(m.map.value=p.map,e(p.map,m.uvTransform)),p.alphaMap&&(m.alphaMap.value=p.alphaMap,e(p.alphaMap,m.alphaMapTransform)),p.alphaTest>0&&(m.alphaTest.value=p.alphaTest)}function c(m,p){m.diffuse.value.copy(p.color),m.opacity.value=p.opacity,m.rotation.value=p.rotation,p.map&&(m.map.value=p.map,e(p.map,m.mapTransform)),p.alphaMap&&(m.alphaMap.value=p.alphaMap,e(p.alphaMap,m.alphaMapTransform)),p.alphaTest>0&&(m.alphaTest.value=p.alphaTest)}function h(m,p){m.specular.value.copy(p.specular),m.shininess.value=Math.max(p.shininess,1e-4)}function u(m,p){p.gradientMap&&(m.gradientMap.value=p.gradientMap)}function f(m,p){m.metalness.value=p.metalness,p.metalnessMap&&(m.metalnessMap.value=p.metalnessMap,e(p.metalnessMap,m.metalnessMapTransform)),m.roughness.value=p.roughness,p.roughnessMap&&(m.roughnessMap.value=p.roughnessMap,e(p.roughnessMap,m.roughnessMapTransform)),p.envMap&&(m.envMapIntensity.value=p.envMapIntensity)}function d(m,p,S){m.ior.value=p.ior,p.diffuseRoughness>0&&(m.diffuseRoughness.value=p.diffuseRoughness,p.diffuseRoughnessMap&&(m.diffuseRoughnessMap.value=p.diffuseRoughnessMap,e(p.diffuseRoughnessMap,m.diffuseRoughnessMapTransform))),p.sheen>0&&(m.sheenColor.value.copy(p.sheenColor).multiplyScalar(p.sheen),m.sheenRoughness.value=p.sheenRoughness,p.sheenColorMap&&(m.sheenColorMap.value=p.sheenColorMap,e(p.sheenColorMap,m.sheenColorMapTransform)),p.sheenRoughnessMap&&(m.sheenRoughnessMap.value=p.sheenRoughnessMap,e(p.sheenRoughnessMap,m.sheenRoughnessMapTransform))),p.clearcoat>0&&(m.clearcoat.value=p.clearcoat,m.clearcoatRoughness.value=p.clearcoatRoughness,p.clearcoatMap&&(m.clearcoatMap.value=p.clearcoatMap,e(p.clearcoatMap,m.clearcoatMapTransform)),p.clearcoatRoughnessMap&&(m.clearcoatRoughnessMap.value=p.clearcoatRoughnessMap,e(p.clearcoatRoughnessMap,m.clearcoatRoughnessMapTransform)),p.clearcoatNormalMap&&(m.clearcoatNormalMap.value=p.clearcoatNormalMap,e(p.clearcoatNormalMap,m.clearcoatNormalMapTransform),m.clearcoatNormalScale.value.copy(p.clearcoatNormalScale),p.side===Vn&&m.clearcoatNormalScale.value.negate())),p.dispersion>0&&(m.dispersion.value=p.dispersion),p.retroreflectivity>0&&(m.retroreflectivity.value=p.retroreflectivity),p.iridescence>0&&(m.iridescence.value=p.iridescence,m.iridescenceIOR.value=p.iridescenceIOR,m.iridescenceThicknessMinimum.value=p.iridescenceThicknessMinimum,m.iridescenceThicknessMaximum.value=p.iridescenceThicknessMaximum,p.iridescenceMap&&(m.iridescenceMap.value=p.iridescenceMap,e(p.iridescenceMap,m.iridescenceMapTransform)),p.iridescenceThicknessMap&&(m.iridescenceThicknessMap.value=p.iridescenceThicknessMap,e(p.iridescenceThicknessMap,m.iridescenceThicknessMapTransform))),p.transmission>0&&(m.transmission.value=p.transmission,m.transmissionSamplerMap.value=S.texture,m.transmissionSamplerSize.value.set(S.width,S.height),p.transmissionMap&&(m.transmissionMap.value=p.transmissionMap,e(p.transmissionMap,m.transmissionMapTransform)),m.thickness.value=p.thickness,p.thicknessMap&&(m.thicknessMap.value=p.thicknessMap,e(p.thicknessMap,m.thicknessMapTransform)),m.attenuationDistance.value=p.attenuationDistance,m.attenuationColor.value.copy(p.attenuationColor)),p.anisotropy>0&&(m.anisotropyVector.value.set(p.anisotropy*Math.cos(p.anisotropyRotation),p.anisotropy*Math.sin(p.anisotropyRotation)),p.anisotropyMap&&(m.anisotropyMap.value=p.anisotropyMap,e(p.anisotropyMap,m.anisotropyMapTransform))),m.specularIntensity.value=p.specularIntensity,m.specularColor.value.copy(p.specularColor),p.specularColorMap&&(m.specularColorMap.value=p.specularColorMap,e(p.specularColorMap,m.specularColorMapTransform)),p.specularIntensityMap&&(m.specularIntensityMap.value=p.specularIntensityMap,e(p.specularIntensityMap,m.specularIntensityMapTransform))}function x(m,p){p.matcap&&(m.matcap.value=p.matcap)}function v(m,p){const S=t.get(p).light;m.referencePosition.value.setFromMatrixPosition(S.matrixWorld),m.nearDistance.value=S.shadow.camera.near,m.farDistance.value=S.shadow.camera.far}return{refreshFogUniforms:n,refreshMaterialUniforms:s}}function wE(i,t,e,n){let s={},r={};function a(S,C){const b=C.program;n.uniformBlockBinding(S,b,s[S.id])}function o(S,C){let b=s[S.id];b===void 0&&(x(S),b=l(S),s[S.id]=b,S.addEventListener("dispose",m));const P=C.program;n.updateUBOMapping(S,P);const T=t.render.frame;r[S.id]!==T&&(c(S),r[S.id]=T)}function l(S){const C=i.createBuffer(),b=S.__size,P=S.usage;return i.bindBuffer(i.UNIFORM_BUFFER,C),i.bufferData(i.UNIFORM_BUFFER,b,P),i.bindBuffer(i.UNIFORM_BUFFER,null),C}function c(S){const C=s[S.id],b=S.uniforms,P=S.__cache;i.bindBuffer(i.UNIFORM_BUFFER,C);for(let T=0,_=b.length;T<_;T++){const w=b[T];if(Array.isArray(w))for(let B=0,I=w.length;B<I;B++)h(w[B],T,B,P);else h(w,T,0,P)}i.bindBuffer(i.UNIFORM_BUFFER,null)}function h(S,C,b,P){if(f(S,C,b,P)===!0){const T=S.__offset,_=S.value;if(Array.isArray(_)){let w=0;for(let B=0;B<_.length;B++){const I=_[B],D=v(I,!0);u(I,S.__data,w),w+=D.storage/Float32Array.BYTES_PER_ELEMENT}}else u(_,S.__data,0);i.bufferSubData(i.UNIFORM_BUFFER,T,S.__data)}}function u(S,C,b){typeof S=="number"||typeof S=="boolean"?C[b]=S:S.isMatrix3?(C[b]=S.elements[0],C[b+1]=S.elements[1],C[b+2]=S.elements[2],C[b+3]=0,C[b+4]=S.elements[3],C[b+5]=S.elements[4],C[b+6]=S.elements[5],C[b+7]=0,C[b+8]=S.elements[6],C[b+9]=S.elements[7],C[b+10]=S.elements[8],C[b+11]=0):ArrayBuffer.isView(S)?C.set(S.subarray(0,C.length-b),b):S.toArray(C,b)}function f(S,C,b,P){const T=S.value,_=C+"_"+b;if(Array.isArray(T)){P[_]===void 0&&(P[_]=[]);const w=P[_];let B=!1;for(let I=0;I<T.length;I++)d(T[I],w,I)===!0&&(B=!0);return B}return d(T,P,_)}function d(S,C,b){if(C[b]===void 0)return typeof S=="number"||typeof S=="boolean"?C[b]=S:ArrayBuffer.isView(S)?C[b]=S.slice():C[b]=S.clone(),!0;{const P=C[b];if(typeof S=="number"||typeof S=="boolean"){if(P!==S)return C[b]=S,!0}else{if(ArrayBuffer.isView(S))return!0;if(P.equals(S)===!1)return P.copy(S),!0}}return!1}function x(S){const C=S.uniforms;let b=0;const P=16;for(let _=0,w=C.length;_<w;_++){const B=Array.isArray(C[_])?C[_]:[C[_]];for(let I=0,D=B.length;I<D;I++){const z=B[I],V=Array.isArray(z.value)?z.value:[z.value],N=Array.isArray(C[_])||Array.isArray(z.value);let H=b;for(let k=0,lt=V.length;k<lt;k++){const Z=V[k],Q=v(Z,N),it=b%P,ut=it%Q.boundary,ht=it+ut;b+=ut,ht!==0&&P-ht<Q.storage&&(b+=P-ht),k===0&&(H=b),b+=Q.storage}const K=z.type==="int"?Int32Array:z.type==="uint"?Uint32Array:Float32Array;z.__data=new K((b-H)/Float32Array.BYTES_PER_ELEMENT),z.__offset=H}}const T=b%P;return T>0&&(b+=P-T),S.__size=b,S.__cache={},this}function v(S,C){const b={boundary:0,storage:0};return typeof S=="number"||typeof S=="boolean"?(b.boundary=4,b.storage=4):S.isVector2?(b.boundary=8,b.storage=8):S.isVector3||S.isColor?(b.boundary=16,b.storage=12):S.isVector4?(b.boundary=16,b.storage=16):S.isMatrix3?(b.boundary=16,b.storage=48):S.isMatrix4?(b.boundary=16,b.storage=64):S.isTexture?Kt("WebGLRenderer: Texture samplers can not be part of an uniforms group."):ArrayBuffer.isView(S)?(b.boundary=16,b.storage=S.byteLength):Kt("WebGLRenderer: Unsupported uniform value type.",S),C===!0&&(b.boundary=16,b.storage=Math.ceil(b.storage/16)*16),b}function m(S){const C=S.target;C.removeEventListener("dispose",m),i.deleteBuffer(s[C.id]),delete s[C.id],delete r[C.id]}function p(){for(const S in s)i.deleteBuffer(s[S]);s={},r={}}return{bind:a,update:o,dispose:p}}const TE=new Uint16Array([12469,15057,12620,14925,13266,14620,13807,14376,14323,13990,14545,13625,14713,13328,14840,12882,14931,12528,14996,12233,15039,11829,15066,11525,15080,11295,15085,10976,15082,10705,15073,10495,13880,14564,13898,14542,13977,14430,14158,14124,14393,13732,14556,13410,14702,12996,14814,12596,14891,12291,14937,11834,14957,11489,14958,11194,14943,10803,14921,10506,14893,10278,14858,9960,14484,14039,14487,14025,14499,13941,14524,13740,14574,13468,14654,13106,14743,12678,14818,12344,14867,11893,14889,11509,14893,11180,14881,10751,14852,10428,14812,10128,14765,9754,14712,9466,14764,13480,14764,13475,14766,13440,14766,13347,14769,13070,14786,12713,14816,12387,14844,11957,14860,11549,14868,11215,14855,10751,14825,10403,14782,10044,14729,9651,14666,9352,14599,9029,14967,12835,14966,12831,14963,12804,14954,12723,14936,12564,14917,12347,14900,11958,14886,11569,14878,11247,14859,10765,14828,10401,14784,10011,14727,9600,14660,9289,14586,8893,14508,8533,15111,12234,15110,12234,15104,12216,15092,12156,15067,12010,15028,11776,14981,11500,14942,11205,14902,10752,14861,10393,14812,9991,14752,9570,14682,9252,14603,8808,14519,8445,14431,8145,15209,11449,15208,11451,15202,11451,15190,11438,15163,11384,15117,11274,15055,10979,14994,10648,14932,10343,14871,9936,14803,9532,14729,9218,14645,8742,14556,8381,14461,8020,14365,7603,15273,10603,15272,10607,15267,10619,15256,10631,15231,10614,15182,10535,15118,10389,15042,10167,14963,9787,14883,9447,14800,9115,14710,8665,14615,8318,14514,7911,14411,7507,14279,7198,15314,9675,15313,9683,15309,9712,15298,9759,15277,9797,15229,9773,15166,9668,15084,9487,14995,9274,14898,8910,14800,8539,14697,8234,14590,7790,14479,7409,14367,7067,14178,6621,15337,8619,15337,8631,15333,8677,15325,8769,15305,8871,15264,8940,15202,8909,15119,8775,15022,8565,14916,8328,14804,8009,14688,7614,14569,7287,14448,6888,14321,6483,14088,6171,15350,7402,15350,7419,15347,7480,15340,7613,15322,7804,15287,7973,15229,8057,15148,8012,15046,7846,14933,7611,14810,7357,14682,7069,14552,6656,14421,6316,14251,5948,14007,5528,15356,5942,15356,5977,15353,6119,15348,6294,15332,6551,15302,6824,15249,7044,15171,7122,15070,7050,14949,6861,14818,6611,14679,6349,14538,6067,14398,5651,14189,5311,13935,4958,15359,4123,15359,4153,15356,4296,15353,4646,15338,5160,15311,5508,15263,5829,15188,6042,15088,6094,14966,6001,14826,5796,14678,5543,14527,5287,14377,4985,14133,4586,13869,4257,15360,1563,15360,1642,15358,2076,15354,2636,15341,3350,15317,4019,15273,4429,15203,4732,15105,4911,14981,4932,14836,4818,14679,4621,14517,4386,14359,4156,14083,3795,13808,3437,15360,122,15360,137,15358,285,15355,636,15344,1274,15322,2177,15281,2765,15215,3223,15120,3451,14995,3569,14846,3567,14681,3466,14511,3305,14344,3121,14037,2800,13753,2467,15360,0,15360,1,15359,21,15355,89,15346,253,15325,479,15287,796,15225,1148,15133,1492,15008,1749,14856,1882,14685,1886,14506,1783,14324,1608,13996,1398,13702,1183]);let Li=null;function AE(){return Li===null&&(Li=new Lp(TE,16,16,zs,Oi),Li.name="DFG_LUT",Li.minFilter=Gn,Li.magFilter=Gn,Li.wrapS=ji,Li.wrapT=ji,Li.generateMipmaps=!1,Li.needsUpdate=!0),Li}class RE{constructor(t={}){const{canvas:e=V0(),context:n=null,depth:s=!0,stencil:r=!1,alpha:a=!1,antialias:o=!1,premultipliedAlpha:l=!0,preserveDrawingBuffer:c=!1,powerPreference:h="default",failIfMajorPerformanceCaveat:u=!1,reversedDepthBuffer:f=!1,outputBufferType:d=jn}=t;this.isWebGLRenderer=!0;let x;if(n!==null){if(typeof WebGLRenderingContext<"u"&&n instanceof WebGLRenderingContext)throw new Error("THREE.WebGLRenderer: WebGL 1 is not supported since r163.");x=n.getContextAttributes().alpha}else x=a;const v=d,m=new Set([yh,Sh,Mh]),p=new Set([jn,Fi,Ea,Lr,_h,xh]),S=new Uint32Array(4),C=new Int32Array(4),b={textures:[],min:[],max:[],resolution:[]};let P=null,T=null;const _=[],w=[];let B=null;this.domElement=e,this.debug={checkShaderErrors:!0,diagnostics:{keywords:!1},onShaderError:null},this.autoClear=!0,this.autoClearColor=!0,this.autoClearDepth=!0,this.autoClearStencil=!0,this.sortObjects=!0,this.clippingPlanes=[],this.localClippingEnabled=!1,this.toneMapping=ns,this.toneMappingExposure=1,this.transmissionResolutionScale=1;const I=this;let D=!1,z=null,V=null,N=null,H=null;this._outputColorSpace=oi;let K=0,k=0,lt=null,Z=-1,Q=null;const it=new je,ut=new je;let ht=null;const j=new se(0);let pt=0,_t=e.width,Tt=e.height,St=1,Gt=null,jt=null;const zt=new je(0,0,_t,Tt),le=new je(0,0,_t,Tt);let re=!1;const Jt=new wa,Ge=new Th;let Fe=!1,tn=!1;const Le=new Pe,xn=new W,xe=new je,hn={background:null,fog:null,environment:null,overrideMaterial:null,isScene:!0};let Xe=!1;function en(){return lt===null?St:1}let F=n;function Rt(E,O){return e.getContext(E,O)}let Xt,te,yt,Ne,Bt,Wt,A,M,X,ct,rt,gt,xt,tt,nt,dt,U,st,et,Et,mt,Mt,Ht;try{const E={alpha:!0,depth:s,stencil:r,antialias:o,premultipliedAlpha:l,preserveDrawingBuffer:c,powerPreference:h,failIfMajorPerformanceCaveat:u};if("setAttribute"in e&&e.setAttribute("data-engine",`three.js r${ph}`),e.addEventListener("webglcontextlost",Ft,!1),e.addEventListener("webglcontextrestored",qt,!1),e.addEventListener("webglcontextcreationerror",At,!1),F===null){const O="webgl2";if(F=Rt(O,E),F===null)throw Rt(O)?new Error("THREE.WebGLRenderer: Error creating WebGL context with your selected attributes."):new Error("THREE.WebGLRenderer: Error creating WebGL context.")}Yt()}catch(E){throw e.removeEventListener("webglcontextlost",Ft,!1),e.removeEventListener("webglcontextrestored",qt,!1),e.removeEventListener("webglcontextcreationerror",At,!1),Ee("WebGLRenderer: "+E.message),E}function Yt(){Xt=new LS(F),Xt.init(),mt=new xE(F,Xt),te=new MS(F,Xt,t,mt),yt=new gE(F,Xt),te.reversedDepthBuffer&&f&&yt.buffers.depth.setReversed(!0),V=F.createFramebuffer(),N=F.createFramebuffer(),H=F.createFramebuffer(),Ne=new IS(F),Bt=new nE,Wt=new _E(F,Xt,yt,Bt,te,mt,Ne),A=new PS(I),M=new Fx(F),Mt=new xS(F,M),X=new DS(F,M,Ne,Mt),ct=new FS(F,X,M,Mt,Ne),st=new US(F,te,Wt),nt=new SS(Bt),rt=new eE(I,A,Xt,te,Mt,nt),gt=new bE(I,Bt),xt=new sE,tt=new hE(Xt),U=new _S(I,A,yt,ct,x,l),dt=new mE(I,ct,te),Ht=new wE(F,Ne,te,yt),et=new vS(F,Xt,Ne),Et=new NS(F,Xt,Ne),Ne.programs=rt.programs,I.capabilities=te,I.extensions=Xt,I.properties=Bt,I.renderLists=xt,I.shadowMap=dt,I.state=yt,I.info=Ne}v!==jn&&(B=new kS(v,e.width,e.height,o,s,r));const ot=new yE(I,F);this.xr=ot,this.getContext=function(){return F},this.getContextAttributes=function(){return F.getContextAttributes()},this.forceContextLoss=function(){const E=Xt.get("WEBGL_lose_context");E&&E.loseContext()},this.forceContextRestore=function(){const E=Xt.get("WEBGL_lose_context");E&&E.restoreContext()},this.getPixelRatio=function(){return St},this.setPixelRatio=function(E){E!==void 0&&(St=E,this.setSize(_t,Tt,!1))},this.getSize=function(E){return E.set(_t,Tt)},this.setSize=function(E,O,J=!0){if(ot.isPresenting){Kt("WebGLRenderer: Can't change size while VR device is presenting.");return}_t=E,Tt=O,e.width=Math.floor(E*St),e.height=Math.floor(O*St),J===!0&&(e.style.width=E+"px",e.style.height=O+"px"),B!==null&&B.setSize(e.width,e.height),this.setViewport(0,0,E,O)},this.getDrawingBufferSize=function(E){return E.set(_t*St,Tt*St).floor()},this.setDrawingBufferSize=function(E,O,J){_t=E,Tt=O,St=J,e.width=Math.floor(E*J),e.height=Math.floor(O*J),this.setViewport(0,0,E,O)},this.setEffects=function(E){if(v===jn){Ee("WebGLRenderer: setEffects() requires outputBufferType set to HalfFloatType or FloatType.");return}if(E){for(let O=0;O<E.length;O++)if(E[O].isOutputPass===!0){Kt("WebGLRenderer: OutputPass is not needed in setEffects(). Tone mapping and color space conversion are applied automatically.");break}}B.setEffects(E||[])},this.getCurrentViewport=function(E){return E.copy(it)},this.getViewport=function(E){return E.copy(zt)},this.setViewport=function(E,O,J,$){E.isVector4?zt.set(E.x,E.y,E.z,E.w):zt.set(E,O,J,$),yt.viewport(it.copy(zt).multiplyScalar(en()).round())},this.getScissor=function(E){return E.copy(le)},this.setScissor=function(E,O,J,$){E.isVector4?le.set(E.x,E.y,E.z,E.w):le.set(E,O,J,$),yt.scissor(ut.copy(le).multiplyScalar(en()).round())},this.getScissorTest=function(){return re},this.setScissorTest=function(E){yt.setScissorTest(re=E)},this.setOpaqueSort=function(E){Gt=E},this.setTransparentSort=function(E){jt=E},this.getClearColor=function(E){return E.copy(U.getClearColor())},this.setClearColor=function(){U.setClearColor(...arguments)},this.getClearAlpha=function(){return U.getClearAlpha()},this.setClearAlpha=function(){U.setClearAlpha(...arguments)},this.clear=function(E=!0,O=!0,J=!0){let $=0;if(E){let Y=!1;if(lt!==null){const bt=lt.texture.format;Y=m.has(bt)}if(Y){const bt=lt.texture.type,Ct=p.has(bt),wt=U.getClearColor(),Pt=U.getClearAlpha(),kt=wt.r,Zt=wt.g,ce=wt.b;Ct?(S[0]=kt,S[1]=Zt,S[2]=ce,S[3]=Pt,F.clearBufferuiv(F.COLOR,0,S)):(C[0]=kt,C[1]=Zt,C[2]=ce,C[3]=Pt,F.clearBufferiv(F.COLOR,0,C))}else $|=F.COLOR_BUFFER_BIT}O&&($|=F.DEPTH_BUFFER_BIT,this.state.buffers.depth.setMask(!0)),J&&($|=F.STENCIL_BUFFER_BIT,this.state.buffers.stencil.setMask(4294967295)),$!==0&&F.clear($)},this.clearColor=function(){this.clear(!0,!1,!1)},this.clearDepth=function(){this.clear(!1,!0,!1)},this.clearStencil=function(){this.clear(!1,!1,!0)},this.setNodesHandler=function(E){E.setRenderer(this),z=E},this.dispose=function(){e.removeEventListener("webglcontextlost",Ft,!1),e.removeEventListener("webglcontextrestored",qt,!1),e.removeEventListener("webglcontextcreationerror",At,!1),U.dispose(),xt.dispose(),tt.dispose(),Wt.dispose(),Bt.dispose(),A.dispose(),ct.dispose(),X.dispose(),Mt.dispose(),Ht.dispose(),rt.dispose(),ot.dispose(),ot.removeEventListener("sessionstart",Ca),ot.removeEventListener("sessionend",yi),Bi.stop()};function Ft(E){E.preventDefault(),lf("WebGLRenderer: Context Lost."),D=!0}function qt(){lf("WebGLRenderer: Context Restored."),D=!1;const E=Ne.autoReset,O=dt.enabled,J=dt.autoUpdate,$=dt.needsUpdate,Y=dt.type;Yt(),Ne.autoReset=E,dt.enabled=O,dt.autoUpdate=J,dt.needsUpdate=$,dt.type=Y}function At(E){Ee("WebGLRenderer: A WebGL context could not be created. Reason: ",E.statusMessage)}function ie(E){const O=E.target;O.removeEventListener("dispose",ie),Oe(O)}function Oe(E){Dn(E),Bt.remove(E)}function Dn(E){const O=Bt.get(E).programs;O!==void 0&&(O.forEach(function(J){rt.releaseProgram(J)}),E.isShaderMaterial&&rt.releaseShaderCache(E))}this.renderBufferDirect=function(E,O,J,$,Y,bt){O===null&&(O=hn);const Ct=Y.isMesh&&Y.matrixWorld.determinantAffine()<0,wt=Vr(E,O,J,$,Y);yt.setMaterial($,Ct);let Pt=J.index,kt=1;if($.wireframe===!0){if(Pt=X.getWireframeAttribute(J),Pt===void 0)return;kt=2}const Zt=J.drawRange,ce=J.attributes.position;let Ot=Zt.start*kt,he=(Zt.start+Zt.count)*kt;bt!==null&&(Ot=Math.max(Ot,bt.start*kt),he=Math.min(he,(bt.start+bt.count)*kt)),Pt!==null?(Ot=Math.max(Ot,0),he=Math.min(he,Pt.count)):ce!=null&&(Ot=Math.max(Ot,0),he=Math.min(he,ce.count));const We=he-Ot;if(We<0||We===1/0)return;Mt.setup(Y,$,wt,J,Pt);let Te,Ae=et;if(Pt!==null&&(Te=M.get(Pt),Ae=Et,Ae.setIndex(Te)),Y.isMesh)$.wireframe===!0?(yt.setLineWidth($.wireframeLinewidth*en()),Ae.setMode(F.LINES)):Ae.setMode(F.TRIANGLES);else if(Y.isLine){let un=$.linewidth;un===void 0&&(un=1),yt.setLineWidth(un*en()),Y.isLineSegments?Ae.setMode(F.LINES):Y.isLineLoop?Ae.setMode(F.LINE_LOOP):Ae.setMode(F.LINE_STRIP)}else Y.isPoints?Ae.setMode(F.POINTS):Y.isSprite&&Ae.setMode(F.TRIANGLES);if(Y.isBatchedMesh)if(Xt.get("WEBGL_multi_draw"))Ae.renderMultiDraw(Y._multiDrawStarts,Y._multiDrawCounts,Y._multiDrawCount);else{const un=Y._multiDrawStarts,It=Y._multiDrawCounts,nn=Y._multiDrawCount,de=Pt?M.get(Pt).bytesPerElement:1,Hi=Bt.get($).currentProgram.getUniforms();for(let sn=0;sn<nn;sn++)Hi.setValue(F,"_gl_DrawID",sn),Ae.render(un[sn]/de,It[sn])}else if(Y.isInstancedMesh)Ae.renderInstances(Ot,We,Y.count);else if(J.isInstancedBufferGeometry){const un=J._maxInstanceCount!==void 0?J._maxInstanceCount:1/0,It=Math.min(J.instanceCount,un);Ae.renderInstances(Ot,We,It)}else Ae.render(Ot,We)};function zr(E,O,J,$){z!==null&&E.isNodeMaterial&&z.setObject($,E),Fe===!0&&nt.setState(E,J,!1),E.transparent===!0&&E.side===Qi&&E.forceSinglePass===!1?(E.side=Vn,E.needsUpdate=!0,Ei(E,O,$),E.side=Bs,E.needsUpdate=!0,Ei(E,O,$),E.side=Qi):Ei(E,O,$)}this.compile=function(E,O,J=null){J===null&&(J=E),z!==null&&z.renderStart(E,O,J),T=tt.get(J),T.init(O),w.push(T),J.traverseVisible(function(Y){Y.isLight&&Y.layers.test(O.layers)&&(T.pushLight(Y),Y.castShadow&&T.pushShadow(Y))}),E!==J&&E.traverseVisible(function(Y){Y.isLight&&Y.layers.test(O.layers)&&(T.pushLight(Y),Y.castShadow&&T.pushShadow(Y))}),T.setupLights(),z!==null&&z.updateLights(T.state.lightsArray),tn=this.localClippingEnabled,Fe=nt.init(this.clippingPlanes,tn),Fe===!0&&nt.setGlobalState(this.clippingPlanes,O),z!==null&&dt.render(T.state.shadowsArray,J,O);const $=new Set;return E.traverse(function(Y){if(!(Y.isMesh||Y.isPoints||Y.isLine||Y.isSprite))return;const bt=Y.material;if(bt)if(Array.isArray(bt))for(let Ct=0;Ct<bt.length;Ct++){const wt=bt[Ct];zr(wt,J,O,Y),$.add(wt)}else zr(bt,J,O,Y),$.add(bt)}),T=w.pop(),z!==null&&z.renderEnd(),$},this.compileAsync=function(E,O,J=null){const $=this.compile(E,O,J);return new Promise(Y=>{function bt(){if($.forEach(function(Ct){const Pt=Bt.get(Ct).currentProgram;(Pt===void 0||Pt.isReady())&&$.delete(Ct)}),$.size===0){Y(E);return}setTimeout(bt,10)}Xt.get("KHR_parallel_shader_compile")!==null?bt():setTimeout(bt,10)})};let Ws=null;function Zo(E){Ws&&Ws(E)}function Ca(){Bi.stop()}function yi(){Bi.start()}const Bi=new Gp;Bi.setAnimationLoop(Zo),typeof self<"u"&&Bi.setContext(self),this.setAnimationLoop=function(E){Ws=E,ot.setAnimationLoop(E),E===null?Bi.stop():Bi.start()},ot.addEventListener("sessionstart",Ca),ot.addEventListener("sessionend",yi),this.render=function(E,O){if(O!==void 0&&O.isCamera!==!0){Ee("WebGLRenderer.render: camera is not an instance of THREE.Camera.");return}if(D===!0)return;z!==null&&z.renderStart(E,O);const J=ot.enabled===!0&&ot.isPresenting===!0,$=B!==null&&(lt===null||J)&&B.begin(I,lt);if(E.matrixWorldAutoUpdate===!0&&E.updateMatrixWorld(),O.parent===null&&O.matrixWorldAutoUpdate===!0&&O.updateMatrixWorld(),ot.enabled===!0&&ot.isPresenting===!0&&(B===null||B.isCompositing()===!1)&&(ot.cameraAutoUpdate===!0&&ot.updateCamera(O),O=ot.getCamera()),E.isScene===!0&&E.onBeforeRender(I,E,O,lt),T=tt.get(E,w.length),T.init(O),T.state.textureUnits=Wt.getTextureUnits(),w.push(T),Le.multiplyMatrices(O.projectionMatrix,O.matrixWorldInverse),O.isArrayCamera?Ge.setFromArrayCamera(O):Jt.setFromProjectionMatrix(Le,Si,O.reversedDepth),tn=this.localClippingEnabled,Fe=nt.init(this.clippingPlanes,tn),P=xt.get(E,_.length),P.init(),_.push(P),this.info.render.frame++,ot.enabled===!0&&ot.isPresenting===!0){const Ct=I.xr.getDepthSensingMesh();Ct!==null&&zi(Ct,O,-1/0,I.sortObjects)}zi(E,O,0,I.sortObjects),P.finish(),z!==null&&z.updateLights(T.state.lightsArray),I.sortObjects===!0&&P.sort(Gt,jt),Xe=ot.enabled===!1||ot.isPresenting===!1||ot.hasDepthSensing()===!1,Xe&&U.addToRenderList(P,E),this.info.autoReset===!0&&this.info.reset(),Fe===!0&&nt.beginShadows();const Y=T.state.shadowsArray;if(dt.render(Y,E,O),Fe===!0&&nt.endShadows(),($&&B.hasRenderPass())===!1){const Ct=P.opaque,wt=P.transmissive;if(T.setupLights(),O.isArrayCamera){const Pt=O.cameras;if(wt.length>0)for(let kt=0,Zt=Pt.length;kt<Zt;kt++){const ce=Pt[kt];ci(Ct,wt,E,ce)}Xe&&U.render(E);for(let kt=0,Zt=Pt.length;kt<Zt;kt++){const ce=Pt[kt];Hr(P,E,ce,ce.viewport)}}else wt.length>0&&ci(Ct,wt,E,O),Xe&&U.render(E),Hr(P,E,O)}lt!==null&&k===0&&(Wt.updateMultisampleRenderTarget(lt),Wt.updateRenderTargetMipmap(lt)),$&&B.end(I),E.isScene===!0&&E.onAfterRender(I,E,O),Mt.resetDefaultState(),Z=-1,Q=null,w.pop(),w.length>0?(T=w[w.length-1],Wt.setTextureUnits(T.state.textureUnits),Fe===!0&&nt.setGlobalState(I.clippingPlanes,T.state.camera)):T=null,_.pop(),_.length>0?P=_[_.length-1]:P=null,z!==null&&z.renderEnd()};function zi(E,O,J,$){if(E.visible===!1)return;if(E.layers.test(O.layers)){if(E.isGroup)J=E.renderOrder;else if(E.isLOD)E.autoUpdate===!0&&E.update(O);else if(E.isLight)T.pushLight(E),E.castShadow&&T.pushShadow(E);else if(E.isSprite){const Ct=O.isArrayCamera?Ge:Jt;if(!E.frustumCulled||E.intersectsFrustum(Ct)){$&&xe.setFromMatrixPosition(E.matrixWorld).applyMatrix4(Le);const wt=ct.update(E),Pt=E.material;Pt.visible&&P.push(E,wt,Pt,J,xe.z,null,O)}}else if(E.isMesh||E.isLine||E.isPoints){const Ct=O.isArrayCamera?Ge:Jt;if(!E.frustumCulled||E.intersectsFrustum(Ct)){const wt=ct.update(E),Pt=E.material;if($&&(E.boundingSphere!==void 0?(E.boundingSphere===null&&E.computeBoundingSphere(),xe.copy(E.boundingSphere.center)):(wt.boundingSphere===null&&wt.computeBoundingSphere(),xe.copy(wt.boundingSphere.center)),xe.applyMatrix4(E.matrixWorld).applyMatrix4(Le)),Array.isArray(Pt)){const kt=wt.groups;for(let Zt=0,ce=kt.length;Zt<ce;Zt++){const Ot=kt[Zt],he=Pt[Ot.materialIndex];he&&he.visible&&P.push(E,wt,he,J,xe.z,Ot,O)}}else Pt.visible&&P.push(E,wt,Pt,J,xe.z,null,O)}}}const bt=E.children;for(let Ct=0,wt=bt.length;Ct<wt;Ct++)zi(bt[Ct],O,J,$)}function Hr(E,O,J,$){const{opaque:Y,transmissive:bt,transparent:Ct}=E;T.setupLightsView(J),Fe===!0&&nt.setGlobalState(I.clippingPlanes,J),$&&yt.viewport(it.copy($)),Y.length>0&&$e(Y,O,J),bt.length>0&&$e(bt,O,J),Ct.length>0&&$e(Ct,O,J),yt.buffers.depth.setTest(!0),yt.buffers.depth.setMask(!0),yt.buffers.color.setMask(!0),yt.setPolygonOffset(!1)}function ci(E,O,J,$){if((J.isScene===!0?J.overrideMaterial:null)!==null)return;if(T.state.transmissionRenderTarget[$.id]===void 0){const Ot=Xt.has("EXT_color_buffer_half_float")||Xt.has("EXT_color_buffer_float");T.state.transmissionRenderTarget[$.id]=new Ii(1,1,{generateMipmaps:!0,type:Ot?Oi:jn,minFilter:Ss,samples:Math.max(4,te.samples),stencilBuffer:r,resolveDepthBuffer:!1,resolveStencilBuffer:!1,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,colorSpace:_e.workingColorSpace})}const bt=T.state.transmissionRenderTarget[$.id],Ct=$.viewport||it;bt.setSize(Ct.z*I.transmissionResolutionScale,Ct.w*I.transmissionResolutionScale);const wt=I.getRenderTarget(),Pt=I.getActiveCubeFace(),kt=I.getActiveMipmapLevel();I.setRenderTarget(bt),I.getClearColor(j),pt=I.getClearAlpha(),pt<1&&I.setClearColor(16777215,.5),I.clear(),Xe&&U.render(J);const Zt=I.toneMapping;I.toneMapping=ns;const ce=$.viewport;if($.viewport!==void 0&&($.viewport=void 0),T.setupLightsView($),Fe===!0&&nt.setGlobalState(I.clippingPlanes,$),$e(E,J,$),Wt.updateMultisampleRenderTarget(bt),Wt.updateRenderTargetMipmap(bt),Xt.has("WEBGL_multisampled_render_to_texture")===!1){let Ot=!1;for(let he=0,We=O.length;he<We;he++){const Te=O[he],{object:Ae,geometry:un,material:It,group:nn}=Te;if(It.side===Qi&&Ae.layers.test($.layers)){const de=It.side;It.side=Vn,It.needsUpdate=!0,Je(Ae,J,$,un,It,nn),It.side=de,It.needsUpdate=!0,Ot=!0}}Ot===!0&&(Wt.updateMultisampleRenderTarget(bt),Wt.updateRenderTargetMipmap(bt))}I.setRenderTarget(wt,Pt,kt),I.setClearColor(j,pt),ce!==void 0&&($.viewport=ce),I.toneMapping=Zt}function $e(E,O,J){const $=O.isScene===!0?O.overrideMaterial:null;for(let Y=0,bt=E.length;Y<bt;Y++){const Ct=E[Y],{object:wt,geometry:Pt,group:kt}=Ct;let Zt=Ct.material;Zt.allowOverride===!0&&$!==null&&(Zt=$),wt.layers.test(J.layers)&&Je(wt,O,J,Pt,Zt,kt)}}function Je(E,O,J,$,Y,bt){z!==null&&Y.isNodeMaterial&&z.setObject(E,Y),E.onBeforeRender(I,O,J,$,Y,bt),E.modelViewMatrix.multiplyMatrices(J.matrixWorldInverse,E.matrixWorld),E.normalMatrix.getNormalMatrix(E.modelViewMatrix),Y.onBeforeRender(I,O,J,$,E,bt),Y.transparent===!0&&Y.side===Qi&&Y.forceSinglePass===!1?(Y.side=Vn,Y.needsUpdate=!0,I.renderBufferDirect(J,O,$,Y,E,bt),Y.side=Bs,Y.needsUpdate=!0,I.renderBufferDirect(J,O,$,Y,E,bt),Y.side=Qi):I.renderBufferDirect(J,O,$,Y,E,bt),E.onAfterRender(I,O,J,$,Y,bt)}function Qe(E){let O=0;for(const J of E)J.texture!==null&&O++;return O}function Ei(E,O,J){O.isScene!==!0&&(O=hn);const $=Bt.get(E),Y=T.state.lights,bt=T.state.shadowsArray,Ct=Y.state.version,wt=rt.getParameters(E,Y.state,bt,O,J,T.state.lightProbeGridArray),Pt=rt.getProgramCacheKey(wt);let kt=$.programs;$.environment=E.isMeshStandardMaterial||E.isMeshLambertMaterial||E.isMeshPhongMaterial?O.environment:null,$.fog=O.fog;const Zt=E.isMeshStandardMaterial||E.isMeshLambertMaterial&&!E.envMap||E.isMeshPhongMaterial&&!E.envMap;$.envMap=A.get(E.envMap||$.environment,Zt),$.envMapRotation=$.environment!==null&&E.envMap===null?O.environmentRotation:E.envMapRotation,kt===void 0&&(E.addEventListener("dispose",ie),kt=new Map,$.programs=kt,$.programVariants=new Map);let ce=kt.get(Pt);if(ce!==void 0){if($.currentProgram===ce&&$.lightsStateVersion===Ct)return Gr(E,wt),ce}else wt.uniforms=rt.getUniforms(E),z!==null&&E.isNodeMaterial&&z.build(E,J,wt),E.onBeforeCompile(wt,I),ce=rt.acquireProgram(wt,Pt),kt.set(Pt,ce),$.uniforms=wt.uniforms;const Ot=$.uniforms;return(!E.isShaderMaterial&&!E.isRawShaderMaterial||E.clipping===!0)&&(Ot.clippingPlanes=nt.uniform),Gr(E,wt),$.needsLights=as(E),$.lightsStateVersion=Ct,$.needsLights&&(Ot.ambientLightColor.value=Y.state.ambient,Ot.lightProbe.value=Y.state.probe,Ot.sunLights.value=Y.state.sun,Ot.sunLightShadows.value=Y.state.sunShadow,Ot.directionalLights.value=Y.state.directional,Ot.directionalLightShadows.value=Y.state.directionalShadow,Ot.spotLights.value=Y.state.spot,Ot.spotLightShadows.value=Y.state.spotShadow,Ot.rectAreaLights.value=Y.state.rectArea,Ot.ltc_1.value=Y.state.rectAreaLTC1,Ot.ltc_2.value=Y.state.rectAreaLTC2,Ot.pointLights.value=Y.state.point,Ot.pointLightShadows.value=Y.state.pointShadow,Ot.hemisphereLights.value=Y.state.hemi,Ot.sunShadowMatrix.value=Y.state.sunShadowMatrix,Ot.sunShadowCascade.value=Y.state.sunShadowCascade,Ot.directionalShadowMatrix.value=Y.state.directionalShadowMatrix,Ot.spotLightMatrix.value=Y.state.spotLightMatrix,Ot.spotLightMap.value=Y.state.spotLightMap,Ot.pointShadowMatrix.value=Y.state.pointShadowMatrix),$.numLightProbeGrids=Qe(T.state.lightProbeGridArray),$.currentProgram=ce,$.uniformsList=null,ce}function Wn(E,O,J,$,Y){const bt=Bt.get(E),Ct=bt.currentProgram.id+","+$+","+Y;let wt=bt.programVariants.get(Ct);return wt===void 0?(wt=Ei(E,O,J),bt.programVariants.set(Ct,wt)):(bt.currentProgram=wt,bt.uniformsList=null,bt.outputColorSpace=$,bt.toneMapping=Y),wt}function rs(E){if(E.uniformsList===null){const O=E.currentProgram.getUniforms();E.uniformsList=wo.seqWithValue(O.seq,E.uniforms)}return E.uniformsList}function Gr(E,O){const J=Bt.get(E);J.outputColorSpace=O.outputColorSpace,J.batching=O.batching,J.batchingColor=O.batchingColor,J.instancing=O.instancing,J.instancingColor=O.instancingColor,J.instancingMorph=O.instancingMorph,J.skinning=O.skinning,J.morphTargets=O.morphTargets,J.morphNormals=O.morphNormals,J.morphColors=O.morphColors,J.morphTargetsCount=O.morphTargetsCount,J.numClippingPlanes=O.numClippingPlanes,J.numIntersection=O.numClipIntersection,J.vertexAlphas=O.vertexAlphas,J.vertexTangents=O.vertexTangents,J.toneMapping=O.toneMapping}function Vr(E,O,J,$,Y){O.isScene!==!0&&(O=hn),Wt.resetTextureUnits();const bt=O.fog,Ct=$.isMeshStandardMaterial||$.isMeshLambertMaterial||$.isMeshPhongMaterial?O.environment:null,wt=lt===null?I.outputColorSpace:lt.isXRRenderTarget===!0?lt.texture.colorSpace:_e.workingColorSpace,Pt=$.isMeshStandardMaterial||$.isMeshLambertMaterial&&!$.envMap||$.isMeshPhongMaterial&&!$.envMap,kt=A.get($.envMap||Ct,Pt),Zt=$.vertexColors===!0&&!!J.attributes.color&&J.attributes.color.itemSize===4,ce=!!J.attributes.tangent&&(!!$.normalMap||$.anisotropy>0),Ot=!!J.morphAttributes.position,he=!!J.morphAttributes.normal,We=!!J.morphAttributes.color;let Te=ns;$.toneMapped&&(lt===null||lt.isXRRenderTarget===!0)&&(Te=I.toneMapping);const Ae=J.morphAttributes.position||J.morphAttributes.normal||J.morphAttributes.color,un=Ae!==void 0?Ae.length:0,It=Bt.get($),nn=T.state.lights;if(Fe===!0&&(tn===!0||E!==Q)){const Re=E===Q&&$.id===Z;nt.setState($,E,Re)}let de=!1,Hi=!1;$.version===It.__version?It.needsLights&&It.lightsStateVersion!==nn.state.version||Y.isBatchedMesh&&It.batching===!1||!Y.isBatchedMesh&&It.batching===!0||Y.isBatchedMesh&&It.batchingColor===!0&&Y._colorsTexture===null||Y.isBatchedMesh&&It.batchingColor===!1&&Y._colorsTexture!==null||Y.isInstancedMesh&&It.instancing===!1||!Y.isInstancedMesh&&It.instancing===!0||Y.isSkinnedMesh&&It.skinning===!1||!Y.isSkinnedMesh&&It.skinning===!0||Y.isInstancedMesh&&It.instancingColor===!0&&Y.instanceColor===null||Y.isInstancedMesh&&It.instancingColor===!1&&Y.instanceColor!==null||Y.isInstancedMesh&&It.instancingMorph===!0&&Y.morphTexture===null||Y.isInstancedMesh&&It.instancingMorph===!1&&Y.morphTexture!==null||It.envMap!==kt||$.fog===!0&&It.fog!==bt||It.numClippingPlanes!==void 0&&(It.numClippingPlanes!==nt.numPlanes||It.numIntersection!==nt.numIntersection)||It.vertexAlphas!==Zt||It.vertexTangents!==ce||It.morphTargets!==Ot||It.morphNormals!==he||It.morphColors!==We||It.morphTargetsCount!==un||It.numLightProbeGrids!==Qe(T.state.lightProbeGridArray)?de=!0:(It.outputColorSpace!==wt||It.toneMapping!==Te)&&(Hi=!0):(de=!0,It.__version=$.version);let sn=It.currentProgram;(de===!0||Hi===!0)&&(sn=Hi===!0?Wn($,O,Y,wt,Te):Ei($,O,Y),z&&$.isNodeMaterial&&z.onUpdateProgram($,sn,It));let Ys=!1,bi=!1,Gi=!1;const ae=sn.getUniforms(),Ye=It.uniforms;if(yt.useProgram(sn.program)&&(Ys=!0,bi=!0,Gi=!0),$.id!==Z&&(Z=$.id,bi=!0),Ys||Q!==E){yt.buffers.depth.getReversed()&&E.reversedDepth!==!0&&(E._reversedDepth=!0,E.updateProjectionMatrix()),ae.setValue(F,"projectionMatrix",E.projectionMatrix),ae.setValue(F,"viewMatrix",E.matrixWorldInverse);const rn=ae.map.cameraPosition;rn!==void 0&&rn.setValue(F,xn.setFromMatrixPosition(E.matrixWorld)),te.logarithmicDepthBuffer&&ae.setValue(F,"logDepthBufFC",2/(Math.log(E.far+1)/Math.LN2)),($.isMeshPhongMaterial||$.isMeshToonMaterial||$.isMeshLambertMaterial||$.isMeshBasicMaterial||$.isMeshStandardMaterial||$.isShaderMaterial)&&ae.setValue(F,"isOrthographic",E.isOrthographicCamera===!0),Q!==E&&(Q=E,bi=!0,Gi=!0)}if(It.needsLights&&(nn.state.sunShadowMap.length>0&&ae.setValue(F,"sunShadowMap",nn.state.sunShadowMap,Wt),nn.state.directionalShadowMap.length>0&&ae.setValue(F,"directionalShadowMap",nn.state.directionalShadowMap,Wt),nn.state.spotShadowMap.length>0&&ae.setValue(F,"spotShadowMap",nn.state.spotShadowMap,Wt),nn.state.pointShadowMap.length>0&&ae.setValue(F,"pointShadowMap",nn.state.pointShadowMap,Wt)),Y.isSkinnedMesh){ae.setOptional(F,Y,"bindMatrix"),ae.setOptional(F,Y,"bindMatrixInverse");const Re=Y.skeleton;Re&&(Re.boneTexture===null&&Re.computeBoneTexture(),ae.setValue(F,"boneTexture",Re.boneTexture,Wt))}Y.isBatchedMesh&&(ae.setOptional(F,Y,"batchingTexture"),ae.setValue(F,"batchingTexture",Y._matricesTexture,Wt),ae.setOptional(F,Y,"batchingIdTexture"),ae.setValue(F,"batchingIdTexture",Y._indirectTexture,Wt),ae.setOptional(F,Y,"batchingColorTexture"),Y._colorsTexture!==null&&ae.setValue(F,"batchingColorTexture",Y._colorsTexture,Wt));const Nn=J.morphAttributes;if((Nn.position!==void 0||Nn.normal!==void 0||Nn.color!==void 0)&&st.update(Y,J,sn),(bi||It.receiveShadow!==Y.receiveShadow)&&(It.receiveShadow=Y.receiveShadow,ae.setValue(F,"receiveShadow",Y.receiveShadow)),($.isMeshStandardMaterial||$.isMeshLambertMaterial||$.isMeshPhongMaterial)&&$.envMap===null&&O.environment!==null&&(Ye.envMapIntensity.value=O.environmentIntensity),Ye.dfgLUT!==void 0&&(Ye.dfgLUT.value=AE()),bi){if(ae.setValue(F,"toneMappingExposure",I.toneMappingExposure),It.needsLights&&Xs(Ye,Gi),bt&&$.fog===!0&&gt.refreshFogUniforms(Ye,bt),gt.refreshMaterialUniforms(Ye,$,St,Tt,T.state.transmissionRenderTarget[E.id]),It.needsLights&&It.numLightProbeGrids>0){const Re=b;let rn=0;for(const Cn of T.state.lightProbeGridArray)Cn.texture!==null&&(Re.textures[rn]=Cn.texture,Re.min[rn]=Cn.boundingBox.min,Re.max[rn]=Cn.boundingBox.max,Re.resolution[rn]=Cn.resolution,rn++);for(const Cn in Re)Re[Cn].length=rn;Ye.probesSH.value=Re.textures,Ye.probesMin.value=Re.min,Ye.probesMax.value=Re.max,Ye.probesResolution.value=Re.resolution}wo.upload(F,rs(It),Ye,Wt)}if($.isShaderMaterial&&$.uniformsNeedUpdate===!0&&(wo.upload(F,rs(It),Ye,Wt),$.uniformsNeedUpdate=!1),$.isSpriteMaterial&&ae.setValue(F,"center",Y.center),ae.setValue(F,"modelViewMatrix",Y.modelViewMatrix),ae.setValue(F,"normalMatrix",Y.normalMatrix),ae.setValue(F,"modelMatrix",Y.matrixWorld),$.uniformsGroups!==void 0){const Re=$.uniformsGroups;for(let rn=0,Cn=Re.length;rn<Cn;rn++){const Pa=Re[rn];Ht.update(Pa,sn),Ht.bind(Pa,sn)}}return sn}function Xs(E,O){E.ambientLightColor.needsUpdate=O,E.lightProbe.needsUpdate=O,E.sunLights.needsUpdate=O,E.sunLightShadows.needsUpdate=O,E.directionalLights.needsUpdate=O,E.directionalLightShadows.needsUpdate=O,E.pointLights.needsUpdate=O,E.pointLightShadows.needsUpdate=O,E.spotLights.needsUpdate=O,E.spotLightShadows.needsUpdate=O,E.rectAreaLights.needsUpdate=O,E.hemisphereLights.needsUpdate=O}function as(E){return E.isMeshLambertMaterial||E.isMeshToonMaterial||E.isMeshPhongMaterial||E.isMeshStandardMaterial||E.isShadowMaterial||E.isShaderMaterial&&E.lights===!0}this.getActiveCubeFace=function(){return K},this.getActiveMipmapLevel=function(){return k},this.getRenderTarget=function(){return lt},this.setRenderTargetTextures=function(E,O,J){const $=Bt.get(E);$.__autoAllocateDepthBuffer=E.resolveDepthBuffer===!1,$.__autoAllocateDepthBuffer===!1&&($.__useRenderToTexture=!1),Bt.get(E.texture).__webglTexture=O,Bt.get(E.depthTexture).__webglTexture=$.__autoAllocateDepthBuffer?void 0:J,$.__hasExternalTextures=!0},this.setRenderTargetFramebuffer=function(E,O){const J=Bt.get(E);J.__webglFramebuffer=O,J.__useDefaultFramebuffer=O===void 0},this.setRenderTarget=function(E,O=0,J=0){lt=E,K=O,k=J;let $=null,Y=!1,bt=!1;if(E){const wt=Bt.get(E);if(wt.__useDefaultFramebuffer!==void 0){yt.bindFramebuffer(F.FRAMEBUFFER,wt.__webglFramebuffer),it.copy(E.viewport),ut.copy(E.scissor),ht=E.scissorTest,yt.viewport(it),yt.scissor(ut),yt.setScissorTest(ht),Z=-1;return}else if(wt.__webglFramebuffer===void 0)Wt.setupRenderTarget(E);else if(wt.__hasExternalTextures)Wt.rebindTextures(E,Bt.get(E.texture).__webglTexture,Bt.get(E.depthTexture).__webglTexture);else if(E.depthBuffer){const Zt=E.depthTexture;if(wt.__boundDepthTexture!==Zt){if(Zt!==null&&Bt.has(Zt)&&(E.width!==Zt.image.width||E.height!==Zt.image.height))throw new Error("THREE.WebGLRenderer: Attached DepthTexture is initialized to the incorrect size.");Wt.setupDepthRenderbuffer(E)}}const Pt=E.texture;(Pt.isData3DTexture||Pt.isDataArrayTexture||Pt.isCompressedArrayTexture)&&(bt=!0);const kt=Bt.get(E).__webglFramebuffer;E.isWebGLCubeRenderTarget?(Array.isArray(kt[O])?$=kt[O][J]:$=kt[O],Y=!0):E.samples>0&&Wt.useMultisampledRTT(E)===!1?$=Bt.get(E).__webglMultisampledFramebuffer:Array.isArray(kt)?$=kt[J]:$=kt,it.copy(E.viewport),ut.copy(E.scissor),ht=E.scissorTest}else it.copy(zt).multiplyScalar(St).floor(),ut.copy(le).multiplyScalar(St).floor(),ht=re;if(J!==0&&($=V),yt.bindFramebuffer(F.FRAMEBUFFER,$)&&yt.drawBuffers(E,$),yt.viewport(it),yt.scissor(ut),yt.setScissorTest(ht),Y){const wt=Bt.get(E.texture);F.framebufferTexture2D(F.FRAMEBUFFER,F.COLOR_ATTACHMENT0,F.TEXTURE_CUBE_MAP_POSITIVE_X+O,wt.__webglTexture,J)}else if(bt){const wt=O;for(let Pt=0;Pt<E.textures.length;Pt++){const kt=Bt.get(E.textures[Pt]);F.framebufferTextureLayer(F.FRAMEBUFFER,F.COLOR_ATTACHMENT0+Pt,kt.__webglTexture,J,wt)}}else if(E!==null&&J!==0){const wt=Bt.get(E.texture);F.framebufferTexture2D(F.FRAMEBUFFER,F.COLOR_ATTACHMENT0,F.TEXTURE_2D,wt.__webglTexture,J)}Z=-1};function $s(E){const O=Bt.get(E);return(O.__readFormat!==E.format||O.__readType!==E.type)&&(O.__readFormat=E.format,O.__readType=E.type,O.__formatReadable=te.textureFormatReadable(E.format),O.__typeReadable=te.textureTypeReadable(E.type)),O}this.readRenderTargetPixels=function(E,O,J,$,Y,bt,Ct,wt=0){if(!(E&&E.isWebGLRenderTarget)){Ee("WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");return}let Pt=Bt.get(E).__webglFramebuffer;if(E.isWebGLCubeRenderTarget&&Ct!==void 0&&(Pt=Pt[Ct],Array.isArray(Pt)&&(Pt=Pt[0])),Pt){yt.bindFramebuffer(F.FRAMEBUFFER,Pt);try{const kt=E.textures[wt],Zt=kt.format,ce=kt.type;E.textures.length>1&&F.readBuffer(F.COLOR_ATTACHMENT0+wt);const Ot=$s(kt);if(Ot.__formatReadable===!1){Ee("WebGLRenderer.readRenderTargetPixels: renderTarget is not in RGBA or implementation defined format.");return}if(Ot.__typeReadable===!1){Ee("WebGLRenderer.readRenderTargetPixels: renderTarget is not in UnsignedByteType or implementation defined type.");return}O>=0&&O<=E.width-$&&J>=0&&J<=E.height-Y&&F.readPixels(O,J,$,Y,mt.convert(Zt),mt.convert(ce),bt)}finally{const kt=lt!==null?Bt.get(lt).__webglFramebuffer:null;yt.bindFramebuffer(F.FRAMEBUFFER,kt)}}},this.readRenderTargetPixelsAsync=async function(E,O,J,$,Y,bt,Ct,wt=0){if(!(E&&E.isWebGLRenderTarget))throw new Error("THREE.WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");let Pt=Bt.get(E).__webglFramebuffer;if(E.isWebGLCubeRenderTarget&&Ct!==void 0&&(Pt=Pt[Ct],Array.isArray(Pt)&&(Pt=Pt[0])),Pt)if(O>=0&&O<=E.width-$&&J>=0&&J<=E.height-Y){yt.bindFramebuffer(F.FRAMEBUFFER,Pt);const kt=E.textures[wt],Zt=kt.format,ce=kt.type;E.textures.length>1&&F.readBuffer(F.COLOR_ATTACHMENT0+wt);const Ot=$s(kt);if(Ot.__formatReadable===!1)throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in RGBA or implementation defined format.");if(Ot.__typeReadable===!1)throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in UnsignedByteType or implementation defined type.");const he=F.createBuffer();F.bindBuffer(F.PIXEL_PACK_BUFFER,he),F.bufferData(F.PIXEL_PACK_BUFFER,bt.byteLength,F.STREAM_READ),F.readPixels(O,J,$,Y,mt.convert(Zt),mt.convert(ce),0),F.bindBuffer(F.PIXEL_PACK_BUFFER,null);const We=lt!==null?Bt.get(lt).__webglFramebuffer:null;yt.bindFramebuffer(F.FRAMEBUFFER,We);const Te=F.fenceSync(F.SYNC_GPU_COMMANDS_COMPLETE,0);return F.flush(),await W0(F,Te,4),F.bindBuffer(F.PIXEL_PACK_BUFFER,he),F.getBufferSubData(F.PIXEL_PACK_BUFFER,0,bt),F.bindBuffer(F.PIXEL_PACK_BUFFER,null),F.deleteBuffer(he),F.deleteSync(Te),bt}else throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: requested read bounds are out of range.")},this.copyFramebufferToTexture=function(E,O=null,J=0){const $=Math.pow(2,-J),Y=Math.floor(E.image.width*$),bt=Math.floor(E.image.height*$),Ct=O!==null?O.x:0,wt=O!==null?O.y:0;Wt.setTexture2D(E,0),F.copyTexSubImage2D(F.TEXTURE_2D,J,0,0,Ct,wt,Y,bt),yt.unbindTexture()},this.copyTextureToTexture=function(E,O,J=null,$=null,Y=0,bt=0){let Ct,wt,Pt,kt,Zt,ce,Ot,he,We;const Te=E.isCompressedTexture?E.mipmaps[bt]:E.image;if(J!==null)Ct=J.max.x-J.min.x,wt=J.max.y-J.min.y,Pt=J.isBox3?J.max.z-J.min.z:1,kt=J.min.x,Zt=J.min.y,ce=J.isBox3?J.min.z:0;else{const ae=Math.pow(2,-Y);Ct=Math.floor(Te.width*ae),wt=Math.floor(Te.height*ae),E.isDataArrayTexture?Pt=Te.depth:E.isData3DTexture?Pt=Math.floor(Te.depth*ae):Pt=1,kt=0,Zt=0,ce=0}$!==null?(Ot=$.x,he=$.y,We=$.z):(Ot=0,he=0,We=0);const Ae=mt.convert(O.format),un=mt.convert(O.type);let It;O.isData3DTexture?(Wt.setTexture3D(O,0),It=F.TEXTURE_3D):O.isDataArrayTexture||O.isCompressedArrayTexture?(Wt.setTexture2DArray(O,0),It=F.TEXTURE_2D_ARRAY):(Wt.setTexture2D(O,0),It=F.TEXTURE_2D),yt.activeTexture(F.TEXTURE0),yt.pixelStorei(F.UNPACK_FLIP_Y_WEBGL,O.flipY),yt.pixelStorei(F.UNPACK_PREMULTIPLY_ALPHA_WEBGL,O.premultiplyAlpha),yt.pixelStorei(F.UNPACK_ALIGNMENT,O.unpackAlignment);const nn=yt.getParameter(F.UNPACK_ROW_LENGTH),de=yt.getParameter(F.UNPACK_IMAGE_HEIGHT),Hi=yt.getParameter(F.UNPACK_SKIP_PIXELS),sn=yt.getParameter(F.UNPACK_SKIP_ROWS),Ys=yt.getParameter(F.UNPACK_SKIP_IMAGES);yt.pixelStorei(F.UNPACK_ROW_LENGTH,Te.width),yt.pixelStorei(F.UNPACK_IMAGE_HEIGHT,Te.height),yt.pixelStorei(F.UNPACK_SKIP_PIXELS,kt),yt.pixelStorei(F.UNPACK_SKIP_ROWS,Zt),yt.pixelStorei(F.UNPACK_SKIP_IMAGES,ce);const bi=E.isDataArrayTexture||E.isData3DTexture,Gi=O.isDataArrayTexture||O.isData3DTexture;if(E.isDepthTexture){const ae=Bt.get(E),Ye=Bt.get(O),Nn=Bt.get(ae.__renderTarget),Re=Bt.get(Ye.__renderTarget);yt.bindFramebuffer(F.READ_FRAMEBUFFER,Nn.__webglFramebuffer),yt.bindFramebuffer(F.DRAW_FRAMEBUFFER,Re.__webglFramebuffer);for(let rn=0;rn<Pt;rn++)bi&&(F.framebufferTextureLayer(F.READ_FRAMEBUFFER,F.COLOR_ATTACHMENT0,Bt.get(E).__webglTexture,Y,ce+rn),F.framebufferTextureLayer(F.DRAW_FRAMEBUFFER,F.COLOR_ATTACHMENT0,Bt.get(O).__webglTexture,bt,We+rn)),F.blitFramebuffer(kt,Zt,kt+Ct,Zt+wt,Ot,he,Ot+Ct,he+wt,F.DEPTH_BUFFER_BIT,F.NEAREST);yt.bindFramebuffer(F.READ_FRAMEBUFFER,null),yt.bindFramebuffer(F.DRAW_FRAMEBUFFER,null)}else if(Y!==0||E.isRenderTargetTexture||Bt.has(E)){const ae=Bt.get(E),Ye=Bt.get(O);yt.bindFramebuffer(F.READ_FRAMEBUFFER,N),yt.bindFramebuffer(F.DRAW_FRAMEBUFFER,H);for(let Nn=0;Nn<Pt;Nn++)bi?F.framebufferTextureLayer(F.READ_FRAMEBUFFER,F.COLOR_ATTACHMENT0,ae.__webglTexture,Y,ce+Nn):F.framebufferTexture2D(F.READ_FRAMEBUFFER,F.COLOR_ATTACHMENT0,F.TEXTURE_2D,ae.__webglTexture,Y),Gi?F.framebufferTextureLayer(F.DRAW_FRAMEBUFFER,F.COLOR_ATTACHMENT0,Ye.__webglTexture,bt,We+Nn):F.framebufferTexture2D(F.DRAW_FRAMEBUFFER,F.COLOR_ATTACHMENT0,F.TEXTURE_2D,Ye.__webglTexture,bt),Y!==0?F.blitFramebuffer(kt,Zt,kt+Ct,Zt+wt,Ot,he,Ot+Ct,he+wt,F.COLOR_BUFFER_BIT,F.NEAREST):Gi?F.copyTexSubImage3D(It,bt,Ot,he,We+Nn,kt,Zt,Ct,wt):F.copyTexSubImage2D(It,bt,Ot,he,kt,Zt,Ct,wt);yt.bindFramebuffer(F.READ_FRAMEBUFFER,null),yt.bindFramebuffer(F.DRAW_FRAMEBUFFER,null)}else Gi?E.isDataTexture||E.isData3DTexture?F.texSubImage3D(It,bt,Ot,he,We,Ct,wt,Pt,Ae,un,Te.data):O.isCompressedArrayTexture?F.compressedTexSubImage3D(It,bt,Ot,he,We,Ct,wt,Pt,Ae,Te.data):F.texSubImage3D(It,bt,Ot,he,We,Ct,wt,Pt,Ae,un,Te):E.isDataTexture?F.texSubImage2D(F.TEXTURE_2D,bt,Ot,he,Ct,wt,Ae,un,Te.data):E.isCompressedTexture?F.compressedTexSubImage2D(F.TEXTURE_2D,bt,Ot,he,Te.width,Te.height,Ae,Te.data):F.texSubImage2D(F.TEXTURE_2D,bt,Ot,he,Ct,wt,Ae,un,Te);yt.pixelStorei(F.UNPACK_ROW_LENGTH,nn),yt.pixelStorei(F.UNPACK_IMAGE_HEIGHT,de),yt.pixelStorei(F.UNPACK_SKIP_PIXELS,Hi),yt.pixelStorei(F.UNPACK_SKIP_ROWS,sn),yt.pixelStorei(F.UNPACK_SKIP_IMAGES,Ys),bt===0&&O.generateMipmaps===!0&&O.mipmapsAutoUpdate===!0&&F.generateMipmap(It),yt.unbindTexture()},this.initRenderTarget=function(E){Bt.get(E).__webglFramebuffer===void 0&&Wt.setupRenderTarget(E)},this.initTexture=function(E){E.isCubeTexture?Wt.setTextureCube(E,0):E.isData3DTexture?Wt.setTexture3D(E,0):E.isDataArrayTexture||E.isCompressedArrayTexture?Wt.setTexture2DArray(E,0):Wt.setTexture2D(E,0),yt.unbindTexture()},this.resetState=function(){K=0,k=0,lt=null,yt.reset(),Mt.reset()},typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}get coordinateSystem(){return Si}get outputColorSpace(){return this._outputColorSpace}set outputColorSpace(t){this._outputColorSpace=t;const e=this.getContext();e.drawingBufferColorSpace=_e._getDrawingBufferColorSpace(t),e.unpackColorSpace=_e._getUnpackColorSpace()}}const rd={type:"change"},Lh={type:"start"},jp={type:"end"},uo=new wh,ad=new Zi,CE=Math.cos(70*Z0.DEG2RAD),fn=new W,Hn=2*Math.PI,be={NONE:-1,ROTATE:0,DOLLY:1,PAN:2,TOUCH_ROTATE:3,TOUCH_PAN:4,TOUCH_DOLLY_PAN:5,TOUCH_DOLLY_ROTATE:6},Kl=1e-6;class PE extends Ix{constructor(t,e=null){super(t,e),this.state=be.NONE,this.target=new W,this.cursor=new W,this.minDistance=0,this.maxDistance=1/0,this.minZoom=0,this.maxZoom=1/0,this.minTargetRadius=0,this.maxTargetRadius=1/0,this.minPolarAngle=0,this.maxPolarAngle=Math.PI,this.minAzimuthAngle=-1/0,this.maxAzimuthAngle=1/0,this.enableDamping=!1,this.dampingFactor=.05,this.enableZoom=!0,this.zoomSpeed=1,this.enableRotate=!0,this.rotateSpeed=1,this.keyRotateSpeed=1,this.enablePan=!0,this.panSpeed=1,this.screenSpacePanning=!0,this.keyPanSpeed=7,this.zoomToCursor=!1,this.autoRotate=!1,this.autoRotateSpeed=2,this.keys={LEFT:"ArrowLeft",UP:"ArrowUp",RIGHT:"ArrowRight",BOTTOM:"ArrowDown"},this.mouseButtons={LEFT:yr.ROTATE,MIDDLE:yr.DOLLY,RIGHT:yr.PAN},this.touches={ONE:xr.ROTATE,TWO:xr.DOLLY_PAN},this.target0=this.target.clone(),this.position0=this.object.position.clone(),this.zoom0=this.object.zoom,this._cursorStyle="auto",this._domElementKeyEvents=null,this._lastPosition=new W,this._lastQuaternion=new ki,this._lastTargetPosition=new W,this._quat=new ki().setFromUnitVectors(t.up,new W(0,1,0)),this._quatInverse=this._quat.clone().invert(),this._spherical=new Ff,this._sphericalDelta=new Ff,this._scale=1,this._panOffset=new W,this._rotateStart=new ee,this._rotateEnd=new ee,this._rotateDelta=new ee,this._panStart=new ee,this._panEnd=new ee,this._panDelta=new ee,this._dollyStart=new ee,this._dollyEnd=new ee,this._dollyDelta=new ee,this._dollyDirection=new W,this._mouse=new ee,this._performCursorZoom=!1,this._pointers=[],this._pointerPositions={},this._controlActive=!1,this._onPointerMove=DE.bind(this),this._onPointerDown=LE.bind(this),this._onPointerUp=NE.bind(this),this._onContextMenu=zE.bind(this),this._onMouseWheel=FE.bind(this),this._onKeyDown=OE.bind(this),this._onTouchStart=kE.bind(this),this._onTouchMove=BE.bind(this),this._onMouseDown=IE.bind(this),this._onMouseMove=UE.bind(this),this._interceptControlDown=HE.bind(this),this._interceptControlUp=GE.bind(this),this.domElement!==null&&this.connect(this.domElement),this.update()}set cursorStyle(t){this._cursorStyle=t,t==="grab"?this.domElement.style.cursor="grab":this.domElement.style.cursor="auto"}get cursorStyle(){return this._cursorStyle}connect(t){super.connect(t),this.domElement.addEventListener("pointerdown",this._onPointerDown),this.domElement.addEventListener("pointercancel",this._onPointerUp),this.domElement.addEventListener("contextmenu",this._onContextMenu),this.domElement.addEventListener("wheel",this._onMouseWheel,{passive:!1}),this.domElement.ownerDocument.addEventListener("keydown",this._interceptControlDown,{passive:!0,capture:!0}),this.domElement.style.touchAction="none"}disconnect(){this.state=be.NONE,this.domElement.removeEventListener("pointerdown",this._onPointerDown),this.domElement.ownerDocument.removeEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.removeEventListener("pointerup",this._onPointerUp),this.domElement.removeEventListener("pointercancel",this._onPointerUp),this.domElement.removeEventListener("wheel",this._onMouseWheel),this.domElement.removeEventListener("contextmenu",this._onContextMenu),this.stopListenToKeyEvents(),this.domElement.ownerDocument.removeEventListener("keydown",this._interceptControlDown,{capture:!0}),this.domElement.ownerDocument.removeEventListener("keyup",this._interceptControlUp,{capture:!0}),this._controlActive=!1,this._pointers.length=0,this._pointerPositions={},this.domElement.style.touchAction="",this.domElement.style.cursor="auto"}dispose(){this.disconnect()}getPolarAngle(){return this._spherical.phi}getAzimuthalAngle(){return this._spherical.theta}getDistance(){return this.object.position.distanceTo(this.target)}listenToKeyEvents(t){t.addEventListener("keydown",this._onKeyDown),this._domElementKeyEvents=t}stopListenToKeyEvents(){this._domElementKeyEvents!==null&&(this._domElementKeyEvents.removeEventListener("keydown",this._onKeyDown),this._domElementKeyEvents=null)}saveState(){this.target0.copy(this.target),this.position0.copy(this.object.position),this.zoom0=this.object.zoom}reset(){this.target.copy(this.target0),this.object.position.copy(this.position0),this.object.zoom=this.zoom0,this.object.updateProjectionMatrix(),this.dispatchEvent(rd),this.update(),this.state=be.NONE}pan(t,e){this._pan(t,e),this.update()}dollyIn(t){this._dollyIn(t),this.update()}dollyOut(t){this._dollyOut(t),this.update()}rotateLeft(t){this._rotateLeft(t),this.update()}rotateUp(t){this._rotateUp(t),this.update()}update(t=null){const e=this.object.position;fn.copy(e).sub(this.target),fn.applyQuaternion(this._quat),this._spherical.setFromVector3(fn),this.autoRotate&&this.state===be.NONE&&this._rotateLeft(this._getAutoRotationAngle(t)),this.enableDamping?(this._spherical.theta+=this._sphericalDelta.theta*this.dampingFactor,this._spherical.phi+=this._sphericalDelta.phi*this.dampingFactor):(this._spherical.theta+=this._sphericalDelta.theta,this._spherical.phi+=this._sphericalDelta.phi);let n=this.minAzimuthAngle,s=this.maxAzimuthAngle;isFinite(n)&&isFinite(s)&&(n<-Math.PI?n+=Hn:n>Math.PI&&(n-=Hn),s<-Math.PI?s+=Hn:s>Math.PI&&(s-=Hn),n<=s?this._spherical.theta=Math.max(n,Math.min(s,this._spherical.theta)):this._spherical.theta=this._spherical.theta>(n+s)/2?Math.max(n,this._spherical.theta):Math.min(s,this._spherical.theta)),this._spherical.phi=Math.max(this.minPolarAngle,Math.min(this.maxPolarAngle,this._spherical.phi)),this._spherical.makeSafe(),this.enableDamping===!0?this.target.addScaledVector(this._panOffset,this.dampingFactor):this.target.add(this._panOffset),this.target.sub(this.cursor),this.target.clampLength(this.minTargetRadius,this.maxTargetRadius),this.target.add(this.cursor);let r=!1;if(this.zoomToCursor&&this._performCursorZoom||this.object.isOrthographicCamera)this._spherical.radius=this._clampDistance(this._spherical.radius);else{const a=this._spherical.radius;this._spherical.radius=this._clampDistance(this._spherical.radius*this._scale),r=a!=this._spherical.radius}if(fn.setFromSpherical(this._spherical),fn.applyQuaternion(this._quatInverse),e.copy(this.target).add(fn),this.object.lookAt(this.target),this.enableDamping===!0?(this._sphericalDelta.theta*=1-this.dampingFactor,this._sphericalDelta.phi*=1-this.dampingFactor,this._panOffset.multiplyScalar(1-this.dampingFactor)):(this._sphericalDelta.set(0,0,0),this._panOffset.set(0,0,0)),this.zoomToCursor&&this._performCursorZoom){let a=null;if(this.object.isPerspectiveCamera){const o=fn.length();a=this._clampDistance(o*this._scale);const l=o-a;this.object.position.addScaledVector(this._dollyDirection,l),this.object.updateMatrixWorld(),r=!!l}else if(this.object.isOrthographicCamera){const o=new W(this._mouse.x,this._mouse.y,0);o.unproject(this.object);const l=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),this.object.updateProjectionMatrix(),r=l!==this.object.zoom;const c=new W(this._mouse.x,this._mouse.y,0);c.unproject(this.object),this.object.position.sub(c).add(o),this.object.updateMatrixWorld(),a=fn.length()}else console.warn("WARNING: OrbitControls.js encountered an unknown camera type - zoom to cursor disabled."),this.zoomToCursor=!1;a!==null&&(this.screenSpacePanning?this.target.set(0,0,-1).transformDirection(this.object.matrix).multiplyScalar(a).add(this.object.position):(uo.origin.copy(this.object.position),uo.direction.set(0,0,-1).transformDirection(this.object.matrix),Math.abs(this.object.up.dot(uo.direction))<CE?this.object.lookAt(this.target):(ad.setFromNormalAndCoplanarPoint(this.object.up,this.target),uo.intersectPlane(ad,this.target))))}else if(this.object.isOrthographicCamera){const a=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),a!==this.object.zoom&&(this.object.updateProjectionMatrix(),r=!0)}return this._scale=1,this._performCursorZoom=!1,r||this._lastPosition.distanceToSquared(this.object.position)>Kl||8*(1-this._lastQuaternion.dot(this.object.quaternion))>Kl||this._lastTargetPosition.distanceToSquared(this.target)>Kl?(this.dispatchEvent(rd),this._lastPosition.copy(this.object.position),this._lastQuaternion.copy(this.object.quaternion),this._lastTargetPosition.copy(this.target),!0):!1}_getAutoRotationAngle(t){return t!==null?Hn/60*this.autoRotateSpeed*t:Hn/60/60*this.autoRotateSpeed}_getZoomScale(t){const e=Math.abs(t*.01);return Math.pow(.95,this.zoomSpeed*e)}_rotateLeft(t){this._sphericalDelta.theta-=t}_rotateUp(t){this._sphericalDelta.phi-=t}_panLeft(t,e){fn.setFromMatrixColumn(e,0),fn.multiplyScalar(-t),this._panOffset.add(fn)}_panUp(t,e){this.screenSpacePanning===!0?fn.setFromMatrixColumn(e,1):(fn.setFromMatrixColumn(e,0),fn.crossVectors(this.object.up,fn)),fn.multiplyScalar(t),this._panOffset.add(fn)}_pan(t,e){const n=this.domElement;if(this.object.isPerspectiveCamera){const s=this.object.position;fn.copy(s).sub(this.target);let r=fn.length();r*=Math.tan(this.object.fov/2*Math.PI/180),this._panLeft(2*t*r/n.clientHeight,this.object.matrix),this._panUp(2*e*r/n.clientHeight,this.object.matrix)}else this.object.isOrthographicCamera?(this._panLeft(t*(this.object.right-this.object.left)/this.object.zoom/n.clientWidth,this.object.matrix),this._panUp(e*(this.object.top-this.object.bottom)/this.object.zoom/n.clientHeight,this.object.matrix)):(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - pan disabled."),this.enablePan=!1)}_dollyOut(t){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale/=t:(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled."),this.enableZoom=!1)}_dollyIn(t){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale*=t:(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled."),this.enableZoom=!1)}_updateZoomParameters(t,e){if(!this.zoomToCursor)return;this._performCursorZoom=!0;const n=this.domElement.getBoundingClientRect(),s=t-n.left,r=e-n.top,a=n.width,o=n.height;this._mouse.x=s/a*2-1,this._mouse.y=-(r/o)*2+1,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()}_clampDistance(t){return Math.max(this.minDistance,Math.min(this.maxDistance,t))}_handleMouseDownRotate(t){this._rotateStart.set(t.clientX,t.clientY)}_handleMouseDownDolly(t){this._updateZoomParameters(t.clientX,t.clientY),this._dollyStart.set(t.clientX,t.clientY)}_handleMouseDownPan(t){this._panStart.set(t.clientX,t.clientY)}_handleMouseMoveRotate(t){this._rotateEnd.set(t.clientX,t.clientY),this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);const e=this.domElement;this._rotateLeft(Hn*this._rotateDelta.x/e.clientHeight),this._rotateUp(Hn*this._rotateDelta.y/e.clientHeight),this._rotateStart.copy(this._rotateEnd),this.update()}_handleMouseMoveDolly(t){this._dollyEnd.set(t.clientX,t.clientY),this._dollyDelta.subVectors(this._dollyEnd,this._dollyStart),this._dollyDelta.y>0?this._dollyOut(this._getZoomScale(this._dollyDelta.y)):this._dollyDelta.y<0&&this._dollyIn(this._getZoomScale(this._dollyDelta.y)),this._dollyStart.copy(this._dollyEnd),this.zoomToCursor&&(this._performCursorZoom=!0,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()),this.update()}_handleMouseMovePan(t){this._panEnd.set(t.clientX,t.clientY),this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd),this.update()}_handleMouseWheel(t){this._updateZoomParameters(t.clientX,t.clientY),t.deltaY<0?this._dollyIn(this._getZoomScale(t.deltaY)):t.deltaY>0&&this._dollyOut(this._getZoomScale(t.deltaY)),this.update()}_handleKeyDown(t){let e=!1;switch(t.code){case this.keys.UP:t.ctrlKey||t.metaKey||t.shiftKey?this.enableRotate&&this._rotateUp(Hn*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(0,this.keyPanSpeed),e=!0;break;case this.keys.BOTTOM:t.ctrlKey||t.metaKey||t.shiftKey?this.enableRotate&&this._rotateUp(-Hn*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(0,-this.keyPanSpeed),e=!0;break;case this.keys.LEFT:t.ctrlKey||t.metaKey||t.shiftKey?this.enableRotate&&this._rotateLeft(Hn*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(this.keyPanSpeed,0),e=!0;break;case this.keys.RIGHT:t.ctrlKey||t.metaKey||t.shiftKey?this.enableRotate&&this._rotateLeft(-Hn*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(-this.keyPanSpeed,0),e=!0;break}e&&(t.preventDefault(),this.update())}_handleTouchStartRotate(t){if(this._pointers.length===1)this._rotateStart.set(t.pageX,t.pageY);else{const e=this._getSecondPointerPosition(t),n=.5*(t.pageX+e.x),s=.5*(t.pageY+e.y);this._rotateStart.set(n,s)}}_handleTouchStartPan(t){if(this._pointers.length===1)this._panStart.set(t.pageX,t.pageY);else{const e=this._getSecondPointerPosition(t),n=.5*(t.pageX+e.x),s=.5*(t.pageY+e.y);this._panStart.set(n,s)}}_handleTouchStartDolly(t){const e=this._getSecondPointerPosition(t),n=t.pageX-e.x,s=t.pageY-e.y,r=Math.sqrt(n*n+s*s);this._dollyStart.set(0,r)}_handleTouchStartDollyPan(t){this.enableZoom&&this._handleTouchStartDolly(t),this.enablePan&&this._handleTouchStartPan(t)}_handleTouchStartDollyRotate(t){this.enableZoom&&this._handleTouchStartDolly(t),this.enableRotate&&this._handleTouchStartRotate(t)}_handleTouchMoveRotate(t){if(this._pointers.length==1)this._rotateEnd.set(t.pageX,t.pageY);else{const n=this._getSecondPointerPosition(t),s=.5*(t.pageX+n.x),r=.5*(t.pageY+n.y);this._rotateEnd.set(s,r)}this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);const e=this.domElement;this._rotateLeft(Hn*this._rotateDelta.x/e.clientHeight),this._rotateUp(Hn*this._rotateDelta.y/e.clientHeight),this._rotateStart.copy(this._rotateEnd)}_handleTouchMovePan(t){if(this._pointers.length===1)this._panEnd.set(t.pageX,t.pageY);else{const e=this._getSecondPointerPosition(t),n=.5*(t.pageX+e.x),s=.5*(t.pageY+e.y);this._panEnd.set(n,s)}this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd)}_handleTouchMoveDolly(t){const e=this._getSecondPointerPosition(t),n=t.pageX-e.x,s=t.pageY-e.y,r=Math.sqrt(n*n+s*s);this._dollyEnd.set(0,r),this._dollyDelta.set(0,Math.pow(this._dollyEnd.y/this._dollyStart.y,this.zoomSpeed)),this._dollyOut(this._dollyDelta.y),this._dollyStart.copy(this._dollyEnd);const a=(t.pageX+e.x)*.5,o=(t.pageY+e.y)*.5;this._updateZoomParameters(a,o)}_handleTouchMoveDollyPan(t){this.enableZoom&&this._handleTouchMoveDolly(t),this.enablePan&&this._handleTouchMovePan(t)}_handleTouchMoveDollyRotate(t){this.enableZoom&&this._handleTouchMoveDolly(t),this.enableRotate&&this._handleTouchMoveRotate(t)}_addPointer(t){this._pointers.push(t.pointerId)}_removePointer(t){delete this._pointerPositions[t.pointerId];for(let e=0;e<this._pointers.length;e++)if(this._pointers[e]==t.pointerId){this._pointers.splice(e,1);return}}_isTrackingPointer(t){for(let e=0;e<this._pointers.length;e++)if(this._pointers[e]==t.pointerId)return!0;return!1}_trackPointer(t){let e=this._pointerPositions[t.pointerId];e===void 0&&(e=new ee,this._pointerPositions[t.pointerId]=e),e.set(t.pageX,t.pageY)}_getSecondPointerPosition(t){const e=t.pointerId===this._pointers[0]?this._pointers[1]:this._pointers[0];return this._pointerPositions[e]}_customWheelEvent(t){const e=t.deltaMode,n={clientX:t.clientX,clientY:t.clientY,deltaY:t.deltaY};switch(e){case 1:n.deltaY*=16;break;case 2:n.deltaY*=100;break}return t.ctrlKey&&!this._controlActive&&(n.deltaY*=10),n}}function LE(i){this.enabled!==!1&&(this._pointers.length===0&&(this.domElement.setPointerCapture(i.pointerId),this.domElement.ownerDocument.addEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.addEventListener("pointerup",this._onPointerUp)),!this._isTrackingPointer(i)&&(this._addPointer(i),i.pointerType==="touch"?this._onTouchStart(i):this._onMouseDown(i),this._cursorStyle==="grab"&&(this.domElement.style.cursor="grabbing")))}function DE(i){this.enabled!==!1&&(i.pointerType==="touch"?this._onTouchMove(i):this._onMouseMove(i))}function NE(i){switch(this._removePointer(i),this._pointers.length){case 0:this.domElement.releasePointerCapture(i.pointerId),this.domElement.ownerDocument.removeEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.removeEventListener("pointerup",this._onPointerUp),this.dispatchEvent(jp),this.state=be.NONE,this._cursorStyle==="grab"&&(this.domElement.style.cursor="grab");break;case 1:const t=this._pointers[0],e=this._pointerPositions[t];this._onTouchStart({pointerId:t,pageX:e.x,pageY:e.y});break}}function IE(i){let t;switch(i.button){case 0:t=this.mouseButtons.LEFT;break;case 1:t=this.mouseButtons.MIDDLE;break;case 2:t=this.mouseButtons.RIGHT;break;default:t=-1}switch(t){case yr.DOLLY:if(this.enableZoom===!1)return;this._handleMouseDownDolly(i),this.state=be.DOLLY;break;case yr.ROTATE:if(i.ctrlKey||i.metaKey||i.shiftKey){if(this.enablePan===!1)return;this._handleMouseDownPan(i),this.state=be.PAN}else{if(this.enableRotate===!1)return;this._handleMouseDownRotate(i),this.state=be.ROTATE}break;case yr.PAN:if(i.ctrlKey||i.metaKey||i.shiftKey){if(this.enableRotate===!1)return;this._handleMouseDownRotate(i),this.state=be.ROTATE}else{if(this.enablePan===!1)return;this._handleMouseDownPan(i),this.state=be.PAN}break;default:this.state=be.NONE}this.state!==be.NONE&&this.dispatchEvent(Lh)}function UE(i){switch(this.state){case be.ROTATE:if(this.enableRotate===!1)return;this._handleMouseMoveRotate(i);break;case be.DOLLY:if(this.enableZoom===!1)return;this._handleMouseMoveDolly(i);break;case be.PAN:if(this.enablePan===!1)return;this._handleMouseMovePan(i);break}}function FE(i){this.enabled===!1||this.enableZoom===!1||this.state!==be.NONE||(i.preventDefault(),this.dispatchEvent(Lh),this._handleMouseWheel(this._customWheelEvent(i)),this.dispatchEvent(jp))}function OE(i){this.enabled!==!1&&this._handleKeyDown(i)}function kE(i){switch(this._trackPointer(i),this._pointers.length){case 1:switch(this.touches.ONE){case xr.ROTATE:if(this.enableRotate===!1){this.state=be.NONE;break}this._handleTouchStartRotate(i),this.state=be.TOUCH_ROTATE;break;case xr.PAN:if(this.enablePan===!1){this.state=be.NONE;break}this._handleTouchStartPan(i),this.state=be.TOUCH_PAN;break;default:this.state=be.NONE}break;case 2:switch(this.touches.TWO){case xr.DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchStartDollyPan(i),this.state=be.TOUCH_DOLLY_PAN;break;case xr.DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchStartDollyRotate(i),this.state=be.TOUCH_DOLLY_ROTATE;break;default:this.state=be.NONE}break;default:this.state=be.NONE}this.state!==be.NONE&&this.dispatchEvent(Lh)}function BE(i){switch(this._trackPointer(i),this.state){case be.TOUCH_ROTATE:if(this.enableRotate===!1)return;this._handleTouchMoveRotate(i),this.update();break;case be.TOUCH_PAN:if(this.enablePan===!1)return;this._handleTouchMovePan(i),this.update();break;case be.TOUCH_DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchMoveDollyPan(i),this.update();break;case be.TOUCH_DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchMoveDollyRotate(i),this.update();break;default:this.state=be.NONE}}function zE(i){this.enabled!==!1&&i.preventDefault()}function HE(i){i.key==="Control"&&(this._controlActive=!0,this.domElement.ownerDocument.addEventListener("keyup",this._interceptControlUp,{passive:!0,capture:!0}))}function GE(i){i.key==="Control"&&(this._controlActive=!1,this.domElement.ownerDocument.removeEventListener("keyup",this._interceptControlUp,{passive:!0,capture:!0}))}const VE=10,WE=1.3,XE=new W(0,1,0);class $E{constructor(t){this.world=t,this.reserve(64)}mesh=null;capacity=0;used=0;px_m=0;eye=new W;along=new W;middle=new W;turn=new ki;size=new W;matrix=new Pe;begin(t,e){this.used=0,this.eye.copy(t.position),this.px_m=2*Math.tan(t.fov*Math.PI/360)/Math.max(1,e)}add(t,e,n,s){this.along.subVectors(e,t);const r=this.along.length();if(!(r>1e-6))return;this.used===this.capacity&&this.reserve(2*this.capacity),this.middle.addVectors(t,e).multiplyScalar(.5);const a=Math.max(n,WE*this.px_m*this.middle.distanceTo(this.eye));this.turn.setFromUnitVectors(XE,this.along.multiplyScalar(1/r)),this.matrix.compose(this.middle,this.turn,this.size.set(a,r,a)),this.mesh.setMatrixAt(this.used,this.matrix),this.mesh.setColorAt(this.used++,s)}end(){const t=this.mesh;t.count=this.used,t.instanceMatrix.needsUpdate=!0,t.instanceColor&&(t.instanceColor.needsUpdate=!0)}reserve(t){const e=this.mesh,n=new Dp(new Rh(1,1,1,VE,1),new kp,t);n.instanceMatrix.setUsage(Io),n.frustumCulled=!1,e&&(n.instanceMatrix.array.set(e.instanceMatrix.array),n.setColorAt(0,new se),e.instanceColor&&n.instanceColor.array.set(e.instanceColor.array),this.world.remove(e),e.geometry.dispose(),e.dispose()),this.mesh=n,this.capacity=t,this.world.add(n)}}const YE=90,qE=6e4,KE=.017,od=.009,ZE=.1;class ld{constructor(t){this.capacity=t;const e=new li;this.position=new Float32Array(t*6),this.colour=new Float32Array(t*8),e.setAttribute("position",new Ui(this.position,3).setUsage(Io)),e.setAttribute("color",new Ui(this.colour,4).setUsage(Io)),this.object=new Np(e,new Ah({vertexColors:!0,transparent:!0,depthWrite:!1})),this.object.frustumCulled=!1}object;position;colour;used=0;begin(){this.used=0}add(t,e,n,s,r,a,o,l,c){this.used!==this.capacity&&(this.position.set([t,e,n,s,r,a],6*this.used),this.colour.set([o[0],o[1],o[2],l,o[0],o[1],o[2],c],8*this.used),++this.used)}end(){const{geometry:t}=this.object;t.setDrawRange(0,2*this.used);for(const[e,n]of[["position",6],["color",8]]){const s=t.getAttribute(e);s.clearUpdateRanges(),s.addUpdateRange(0,n*this.used),s.needsUpdate=!0}}}class JE{constructor(t,e,n){this.state=t,this.colours=e,this.redraw=n,this.overlay=new jc(t,e),this.element.className="view space",this.element.append(this.renderer.domElement,this.overlay.canvas),this.renderer.setPixelRatio(Math.min(devicePixelRatio,2)),this.camera.up.set(0,0,1),this.controls=new PE(this.camera,this.element),this.controls.enableDamping=!1,this.controls.zoomToCursor=!0,this.controls.maxPolarAngle=.97*Math.PI,this.controls.addEventListener("change",this.redraw),this.markers=this.make_markers(128);const s=new Dx(16777215,1.5);s.position.set(2,-3,5),this.world.add(new Cx(16777215,9082016,2),s,this.floor,this.rig,this.trails.object,this.rays.object),this.bones=new $E(this.world)}element=document.createElement("div");overlay;renderer=new RE({antialias:!0,alpha:!1,preserveDrawingBuffer:!1});world=new hx;camera=new _i(42,1,.02,500);controls;markers;trails=new ld(qE);bones;keypoint_bones=[];rays=new ld(8e3);floor=new vr;rig=new vr;camera_names=[];tracks=new Map;scene=null;low=new W(-2,-2,0);high=new W(2,2,2);framed=!1;capacity=0;dark=null;scratch={matrix:new Pe,colour:new se,v:new W,q:new ki};take(t){this.scene=t,this.tracks=new Map(t.tracks.map(e=>[e.id,e])),this.keypoint_bones=hd(t),t.low&&t.high&&(this.low.set(...t.low),this.high.set(...t.high)),this.dark=null,(!this.framed||t.complete)&&(this.framed||this.reset(),this.framed=t.kind==="live"||t.low!==void 0)}resize(t,e){this.camera.aspect=t/Math.max(1,e),this.camera.updateProjectionMatrix(),this.renderer.setSize(t,e),this.overlay.resize(t,e),this.moved_by_user===0&&this.reset()}moved_by_user=0;reset(){this.look(new W(.75,-1,.42))}view_from(t){this.look(t==="top"?new W(0,-.001,1):t==="front"?new W(0,-1,.06):new W(1,0,.06))}look(t){const e=new W().addVectors(this.low,this.high).multiplyScalar(.5),n=new W().subVectors(this.high,this.low),s=Math.max(.3,.5*n.length()),r=Math.atan(Math.tan(this.camera.fov*Math.PI/360)*Math.min(1,this.camera.aspect)),a=.9*s/Math.sin(r);this.camera.position.copy(t.normalize().multiplyScalar(a).add(e)),this.camera.near=a/200,this.camera.far=a*60,this.camera.updateProjectionMatrix(),this.controls.target.copy(e),this.controls.update()}draw(t,e){this.dark!==this.state.dark&&this.paint_surroundings(),this.rig.visible=this.state.cameras;const n=e?this.place_markers(e):[];this.place_trails(t,e),this.place_bones(e),this.place_rays(e),this.renderer.render(this.world,this.camera),this.overlay.clear(),this.state.cameras&&this.name_cameras(),this.overlay.labels(n,this.state.labels)}room(){return Math.max(.5,Math.min(12,new W().subVectors(this.high,this.low).length()/4))}place_markers(t){const{chunk:e,k:n}=t,s=e.row_end[n],r=e.begin(n);s-r>this.capacity&&(this.markers=this.make_markers(2*(s-r)));const{matrix:a,colour:o,v:l}=this.scratch,c=[],h=this.room()*KE,u=this.overlay.height/2/Math.tan(this.camera.fov*Math.PI/360);let f=0;for(let d=r;d<s;++d){const x=e.track[d];if(this.state.hidden.has(x))continue;const v=this.state.selected.has(x),m=h*(v||this.state.hover===x?1.5:1),p=e.z?e.z[d]:0;a.makeScale(m,m,m).setPosition(e.x[d],e.y[d],p),this.markers.setMatrixAt(f,a),o.setRGB(...this.colours.rgb(x),"srgb");const S=e.provenance(d);e.sigma&&o.lerp(this.background,1-al(e,d)),(S===np||S===ip)&&o.lerp(this.background,.6),this.state.selected.size>0&&!v&&o.lerp(this.background,.35),this.markers.setColorAt(f++,o),l.set(e.x[d],e.y[d],p);const C=l.distanceTo(this.camera.position);l.project(this.camera),!(l.z>1||Math.abs(l.x)>1||Math.abs(l.y)>1)&&c.push({id:x,x:(l.x+1)/2*this.overlay.width,y:(1-l.y)/2*this.overlay.height,radius:m*u/C+1,text:wr(this.tracks.get(x),x),depth:C})}return this.markers.count=f,this.markers.instanceMatrix.needsUpdate=!0,this.markers.instanceColor&&(this.markers.instanceColor.needsUpdate=!0),c}place_trails(t,e){if(this.trails.begin(),e&&this.state.trail_s>0){const n=Ji(e),s=new Map,r=this.state.selected.size>0;for(const{chunk:a,k:o}of md(t,e,this.state.trail_s,YE)){const l=a.time[o],c=.75*(1-(n-l)/this.state.trail_s);for(let h=a.begin(o);h<a.row_end[o];++h){const u=a.track[h];if(this.state.hidden.has(u)||r&&!this.state.selected.has(u))continue;const f=a.z?a.z[h]:0,d=s.get(u);d&&d[3]-l<.25&&this.trails.add(a.x[h],a.y[h],f,d[0],d[1],d[2],this.linear(u),c,c+.02),s.set(u,[a.x[h],a.y[h],f,l])}}}this.trails.end()}linear(t){return this.scratch.colour.setRGB(...this.colours.rgb(t),"srgb"),[this.scratch.colour.r,this.scratch.colour.g,this.scratch.colour.b]}place_bones(t){if(this.bones.begin(this.camera,this.overlay.height),t&&this.scene&&this.scene.bodies.length>0){const{chunk:e,k:n}=t,s=new Map;for(let u=e.pose_begin(n);u<e.pose_end[n];++u)s.set(e.body[u],u);const r=u=>new W(e.pose[0][u],e.pose[1][u],e.pose[2][u]),a=(u,f)=>f.applyQuaternion(this.scratch.q.set(e.pose[3][u],e.pose[4][u],e.pose[5][u],e.pose[6][u])).add(r(u)),o=new se(this.state.dark?11844808:4871523),l=o.clone().lerp(this.background,.6),c=[16711680,43554,2250239].map(u=>new se(u)),h=this.room()*od;for(const u of this.scene.bodies){const f=s.get(u.id);if(f===void 0)continue;const d=e.tracked[f]?o:l,x=u.parent===void 0?void 0:s.get(u.parent);if(x!==void 0&&this.bones.add(r(x),r(f),h,d),u.end&&this.bones.add(r(f),a(f,new W(...u.end)),h,d),u.skeleton===""){for(const v of u.markers)this.bones.add(r(f),a(f,new W(...v)),.3*h,d);for(let v=0;v<3;++v)this.bones.add(r(f),a(f,new W().setComponent(v,ZE)),.6*h,e.tracked[f]?c[v]:c[v].clone().lerp(this.background,.6))}}}t&&this.place_keypoint_bones(t),this.bones.end()}place_keypoint_bones(t){if(this.keypoint_bones.length===0)return;const{chunk:e,k:n}=t,s=new Map;for(let o=e.begin(n);o<e.row_end[n];++o)s.set(e.track[o],o);const r=o=>new W(e.x[o],e.y[o],e.z?e.z[o]:0),a=.6*this.room()*od;for(const[o,l]of this.keypoint_bones){const c=s.get(o),h=s.get(l);if(c===void 0||h===void 0||this.state.hidden.has(o)||this.state.hidden.has(l))continue;const u=new se().setRGB(...this.colours.rgb(o),"srgb");u.lerp(this.background,1-Math.min(al(e,c),al(e,h))),this.bones.add(r(c),r(h),a,u)}}place_rays(t){if(this.rays.begin(),t&&this.state.rays&&t.chunk.cameras){const{chunk:e,k:n}=t,s=(this.scene?.cameras??[]).map(a=>a.centre),r=this.state.selected.size>0;for(let a=e.begin(n);a<e.row_end[n];++a){const o=e.track[a];if(!(this.state.hidden.has(o)||r&&!this.state.selected.has(o)||e.provenance(a)!==G_))for(let l=0;l<Math.min(32,s.length);++l){const c=s[l];!c||!(e.cameras[a]&1<<l)||this.rays.add(c[0],c[1],c[2],e.x[a],e.y[a],e.z[a],this.linear(o),.15,r?.8:.4)}}}this.rays.end()}background=new se;make_markers(t){this.markers&&(this.world.remove(this.markers),this.markers.dispose()),this.capacity=t;const e=new Dp(new Ch(1,16,12),new kp,t);return e.instanceMatrix.setUsage(Io),e.frustumCulled=!1,e.count=0,this.world.add(e),e}paint_surroundings(){this.dark=this.state.dark,this.background.set(this.dark?921877:16053751),this.world.background=this.background,this.floor.clear(),this.rig.clear(),this.camera_names=[],this.paint_floor();for(const t of this.scene?.cameras??[])t.centre&&t.corners?.length===4&&this.paint_camera(t.name,t.centre,t.corners)}paint_floor(){const t=(this.scene?.cameras??[]).flatMap(c=>c.centre?[c.centre]:[]),e=(c,h)=>{const u=[h>0?this.high.getComponent(c):this.low.getComponent(c),...t.map(d=>d[c])],f=h>0?Math.max(...u):Math.min(...u);return Math.max(-60,Math.min(60,h>0?Math.ceil(f+.5):Math.floor(f-.5)))},[n,s,r,a]=[e(0,-1),e(0,1),e(1,-1),e(1,1)],o=[];for(let c=n;c<=s;++c)c!==0&&o.push(c,r,0,c,a,0);for(let c=r;c<=a;++c)c!==0&&o.push(n,c,0,s,c,0);this.floor.add(Zl(o,this.dark?2436149:14278115));const l=(c,h)=>this.floor.add(Zl(c,h));l([n,0,0,s,0,0],this.dark?5913148:14262432),l([0,r,0,0,a,0],this.dark?3756863:10274723)}paint_camera(t,e,n){const s=.09*Math.max(2,Math.min(20,new W().subVectors(this.high,this.low).length())),r=o=>o.map((l,c)=>e[c]+s*l),a=[];for(let o=0;o<4;++o)a.push(...e,...r(n[o]),...r(n[o]),...r(n[(o+1)%4]));this.rig.add(Zl(a,this.dark?6453391:8361387)),this.camera_names.push({name:t,at:new W(...e)})}name_cameras(){const{draw:t,width:e,height:n}=this.overlay;t.font=`10.5px ${pa}`,t.textAlign="center",t.fillStyle=this.state.dark?"#7d93ab":"#5d7388";for(const{name:s,at:r}of this.camera_names){const a=r.clone().project(this.camera);a.z<1&&t.fillText(s,(a.x+1)/2*e,(1-a.y)/2*n-9)}t.textAlign="left"}}function Zl(i,t){const e=new li;return e.setAttribute("position",new wn(i,3)),new Np(e,new Ah({color:t}))}function QE(i,t,e,n){if(i.frame!=="space")return new go(t,e,n);try{return new JE(t,e,n)}catch{return new l0(t,e)}}const[cd,oa,jE,tb]=[16,14,118,160],Dh={wand:{it:"The wand was",invite:"Wave the wand through the whole volume",computing:"Put the wand down; this takes some seconds."},people:{it:"People were",invite:"Walk through the whole volume, near and far",computing:"The recorded videos are searched for people; this takes some minutes."}},eb=i=>i!==void 0&&i in Dh,me=(i,t="",e="")=>{const n=document.createElement(i);return n.className=t,n.textContent=e,n},fo=i=>`${i.slice(0,1).toUpperCase()}${i.slice(1)}`,va=i=>`${(100*i).toFixed(0)} %`,la=(i,...t)=>{const e=me("tr");return e.append(...t.map(n=>me(i,"",n))),e};class nb{constructor(t,e){this.kind=t,this.waved=e;const n=me("div","coverage_bar");n.append(this.bar,me("b")),this.element.append(n,this.words,this.pairs)}element=me("div","waved");bar=me("i");words=me("p","coverage");pairs=me("p","pairs");seen=null;aspect=4/3;take(t,e){this.seen=e;const{required:n,needed:s,shared:r,cameras:a}=this.waved();this.bar.style.width=`${Math.min(100,100*e.coverage/n)}%`,this.element.classList.toggle("enough",e.covered),e.state==="live"||e.state==="back"?ge(this.words,e.covered?`Enough: ${va(e.coverage)} of its picture`:`${va(e.coverage)} of its picture; ${va(n)} wanted`):ge(this.words,`The camera is ${e.state}`);const l=(r??[]).filter(c=>c.a===t||c.b===t).map(c=>{const h=a?.[c.a===t?c.b:c.a]?.name??"",u=me("span",c.sufficient?"pair enough":"pair",c.sufficient?`✓ ${h}`:`${h} ${c.views}/${s}`);return u.title=`${Dh[this.kind].it} seen ${c.views} times together with ${h}; ${s} tell how they stand to each other`,u});this.pairs.replaceChildren("Together with ",...l),this.pairs.hidden=l.length===0}draw(t,e,n,s,r){r.width>0&&(this.aspect=r.width/r.height);const{across:a,down:o}=this.waved(),[l,c]=[e/a,n/o];t.fillStyle="#55b97a4d";for(const h of this.seen?.parts??[])t.fillRect(h%a*l,Math.floor(h/a)*c,l,c);t.strokeStyle="#ffffff1f",t.lineWidth=s,t.beginPath();for(let h=1;h<a;++h)t.rect(h*l,0,0,n);for(let h=1;h<o;++h)t.rect(0,h*c,e,0);t.stroke(),this.kind==="wand"?this.draw_wand(t,e/(r.width||e),s,r):this.draw_people(t,e/(r.width||e),s,r)}draw_people(t,e,n,{points:s}){t.fillStyle="#ffd166";for(const r of s.track.keys())s.track[r]<=0||(t.beginPath(),t.arc(e*(s.x[r]+.5),e*(s.y[r]+.5),3*n,0,7),t.fill())}draw_wand(t,e,n,{points:s}){const r=[...s.track.keys()].filter(a=>s.track[a]>0).sort((a,o)=>s.track[a]-s.track[o]);if(r.length!==0){t.strokeStyle="#ffd166",t.lineWidth=2.5*n,t.beginPath();for(const a of r)t.lineTo(e*(s.x[a]+.5),e*(s.y[a]+.5));t.stroke(),t.fillStyle="#ffd166";for(const a of r)t.beginPath(),t.arc(e*(s.x[a]+.5),e*(s.y[a]+.5),4.5*n,0,7),t.fill()}}}class ib{constructor(t,e,n){this.kind=t,this.cameras=e,this.main.id="wand",document.body.classList.add("wand");const s=me("div","words");s.append(this.title,this.detail,this.missing),this.enough.id="enough",this.enough.title="Calibrate by what was seen so far",this.enough.addEventListener("click",()=>n("enough")),this.head.append(s,this.enough),this.set_ground.id="set_ground",this.set_ground.title="Origin and axes by the L-frame that lies on the floor now",this.set_ground.addEventListener("click",()=>{this.set_ground.disabled=!0,n("ground")}),this.floor.append(me("h2","","The floor"),this.floor_words,this.set_ground),this.floor.classList.toggle("absent",this.kind!=="wand"),this.main.append(this.head,this.result,this.floor,this.grid),document.querySelector("#panel").before(this.main),new ResizeObserver(()=>this.arrange()).observe(this.grid),this.tell()}main=me("main");head=me("div","wand_head");title=me("h1");detail=me("p");enough=me("button","","That will do");missing=me("ul","missing");result=me("div","result");floor=me("div","floor");set_ground=me("button","chip","Set the ground");floor_words=me("p");grid=document.querySelector("#cameras");arranged="";cards=[];waved={phase:"waving",required:.3,needed:200,across:10,down:8};frame(t){const e=t.cameras.flatMap(s=>s.centre?[s.centre]:[]);if(e.length<t.cameras.length)return!1;const n=s=>e.map(r=>r[s]);return t.low=[Math.min(...n(0)),Math.min(...n(1)),Math.min(...n(2))],t.high=[Math.max(...n(0)),Math.max(...n(1)),Math.max(...n(2))],!0}arrange(){const t=this.waved.cameras?.length??0,[e,n]=[this.grid.clientWidth-2*cd,this.grid.clientHeight-2*cd];if(t===0||e<=0)return;const s=this.cards.map(c=>c.aspect),r=s.length>0?Math.min(...s):4/3;let a=[1,0];for(let c=1;c<=t;++c){const h=n/Math.ceil(t/c)-oa-jE,u=Math.min((e+oa)/c-oa,h*r);u>a[1]&&(a=[c,u])}const o=Math.max(a[1],Math.min(tb,e)),l=Math.max(1,Math.min(a[0],Math.floor((e+oa)/(o+oa))));this.grid.style.gridTemplateColumns=`repeat(${l}, ${Math.floor(o)}px)`}take(t){this.waved=JSON.parse(t);const{cameras:e}=this.waved;e?.forEach((s,r)=>{this.card(r)?.take(r,s),this.cameras.state(r,s.state)});const n=e?this.cards.map(s=>s.aspect.toFixed(2)).join():"";n!==this.arranged&&(this.arranged=n,this.arrange()),this.tell()}card(t){if(this.cards[t])return this.cards[t];const e=new nb(this.kind,()=>this.waved);return this.cameras.adorn(t,e.element,(...n)=>e.draw(...n))?this.cards[t]=e:null}tell(){const{phase:t,cameras:e,seconds:n,report:s,rig:r,why:a,missing:o}=this.waved,l=Dh[this.kind];this.missing.hidden=t!=="waving"||!o?.length,!this.missing.hidden&&this.missing.textContent!==o.map(fo).join("")&&this.missing.replaceChildren(...o.map(h=>me("li","",fo(h))));const c=e?.filter(h=>h.covered).length??0;document.body.classList.toggle("wand_done",t==="done"),document.body.dataset.wand=t,this.enough.hidden=t!=="waving"||!e,this.head.classList.toggle("bad",t==="failed"),t==="waving"?(ge(this.title,l.invite),ge(this.detail,e?`${c} of ${e.length} cameras have seen enough · ${(n??0).toFixed(0)} s`:"Waiting for the cameras …")):t==="computing"?(ge(this.title,"Enough. Calibrating …"),ge(this.detail,l.computing)):t==="failed"?(ge(this.title,"No rig results from it"),ge(this.detail,a??"")):s&&(ge(this.title,"Calibrated"),ge(this.detail,`The rig was written to ${r??""}`),this.result.replaceChildren(..."grade"in s?this.judged(s):this.told(s)),this.tell_floor())}tell_floor(){const{ground:t}=this.waved,e=t?.phase==="looking";this.set_ground.disabled=e,ge(this.set_ground,t?.phase==="set"?"Set it again":"Set the ground"),this.floor.dataset.phase=t?.phase??"",t?e?ge(this.floor_words,"Looking at the L-frame for three seconds …"):t.phase==="set"?ge(this.floor_words,[`The ground is set; the L-frame fits to ${(t.rms_mm??0).toFixed(2)} mm. The rig file has it.`,...t.warnings??[]].join(" ")):ge(this.floor_words,`Not set: ${t.why??""}`):ge(this.floor_words,"Lay the L-frame down, step back, and set the ground: its first marker becomes the origin, z is up.")}told(t){const e=me("table","each");e.append(la("th","Camera","Error","Place","Focal length","Coverage"));for(const[s,{rms_px:r,deviation:a,coverage:o}]of Object.entries(t.cameras))e.append(la("td",s,`${r.toFixed(1)} px`,`± ${(a.centre_mm/10).toFixed(1)} cm`,`± ${(100*a.focal).toFixed(1)} %`,va(o)));const n=me("ul");n.append(me("li","",`${t.people===1?"One person was":`${t.people} people were`} seen by two cameras or more; height ${t.height_m.toFixed(2)} m; the floor is z = 0`));for(const s of t.notes)n.append(me("li","",fo(s.replaceAll("`",""))));return[e,n,me("p","hint","Close this page to end.")]}judged(t){const e=me("p",`grade ${t.grade}`);e.append(me("strong","",t.grade),me("span","",t.grade_text));const n=me("table");n.append(la("th","Camera","Error","In space","Coverage"));for(const[o,l]of Object.entries(t.cameras))n.append(la("td",o,`${l.mean_px.toFixed(2)} px`,`${l.world_error_mm.toFixed(2)} mm`,va(l.coverage)));n.append(la("td","All",`${t.all.mean_px.toFixed(2)} px`,"",""));const s=me("ul"),{held_out:r,volume:a}=t;r&&s.append(me("li","",`Judged on ${r.frames} places of the wand that took no part: its length is off by ${r.length_rms_mm.toFixed(2)} mm`)),s.append(me("li","",`A marker's place is known to ${a.median_mm.toFixed(2)} mm, in the worst tenth of the volume to ${a.p90_mm.toFixed(2)} mm`));for(const o of t.notes)s.append(me("li","",fo(o.replaceAll("`",""))));return[e,n,s,me("p","hint","Close this page to end.")]}}const Ki=i=>document.querySelector(`#${i}`),Jl=(i,t)=>`${i} ${t}${i===1?"":"s"}`;class sb{constructor(t,e,n){this.motion=t,this.colours=e,this.latency=n}status={};updated=0;update(){const{scene:t}=this.motion(),e=t.kind==="live";ge(Ki("list_tab"),{space:"Markers",ground:"People",image:"Tracks"}[t.frame]);const n=t.job==="wand"?"Wand calibration":t.job==="people"?"Calibration by people":e?"Live":t.name.split("/").pop()||"Recording";ge(Ki("title"),n),document.title=`${n} – Marey`,Ki("record").hidden=!t.can_record,Ki("pictures_tab").hidden=!e||t.cameras.length===0;for(const s of["rig","rays"])Ki(s).hidden=!(t.frame==="space"&&t.cameras.some(r=>r.centre));for(const s of["top","front","side"])Ki(s).hidden=t.frame!=="space";this.legend(),this.facts(),this.about()}legend(){Ki("legend").replaceChildren(...this.colours.legend().map(([t,e])=>{const n=document.createElement("span"),s=document.createElement("i");return s.style.background=e,n.append(s,t),n}))}live_facts(){this.motion().scene.kind==="live"&&performance.now()-this.updated>400&&this.facts()}facts(){const t=this.motion(),{scene:e}=t,n=[],s=t instanceof vs?t.count():e.tracks.length;if(s&&n.push(Jl(s,e.frame==="space"?"marker":"track")),t instanceof vs){const r=t.rate();r>0&&n.push(`${r.toFixed(0)} Hz`);const a=this.latency.of(.5);a!==null&&n.push(`${a.toFixed(0)} ms`)}else n.push(_r(t.last-t.first),`${+e.rate.toFixed(2)} Hz`),e.complete||n.push("reading …"),e.warnings?.length&&n.push(Jl(e.warnings.length,"warning"));ge(Ki("facts"),n.join(" · ")),this.updated=performance.now()}about(){const t=this.motion(),{scene:e}=t,n=l=>`${(1e3*l).toFixed(1)} ms`,s=[["Name",e.name]];s.push(["Holds",{space:"markers in space, m, z up",ground:"places on the ground, m",image:"tracks in an image, px"}[e.frame]]),pd(e)&&s.push(["Seen","these places were computed (joints, say), not seen by cameras"]),e.made_by&&s.push(["Made by",e.made_by]),e.kind==="recording"&&s.push(["Length",`${_r(t.last-t.first)}, ${e.instants} instants at ${+e.rate.toFixed(3)} Hz`]),e.cameras.length?s.push(["Cameras",e.cameras.map(l=>l.name).join(", ")]):e.frame==="space"&&e.kind==="recording"&&s.push(["Cameras","this file holds no calibration, so that neither they nor rays can be shown; a take does"]),e.bodies.length&&s.push(["Bodies",e.bodies.map(l=>l.label).join(", ")]);for(const l of this.status.steps??[])s.push([l.name,`${n(l.median)}, 99 % within ${n(l.p99)}`]);this.status.superseded!==void 0&&s.push(["Overtaken",Jl(this.status.superseded,"moment")]);const[r,a]=[this.latency.of(.5),this.latency.of(.95)];r!==null&&a!==null&&s.push(["Capture to screen",`${r.toFixed(0)} ms, 95 % within ${a.toFixed(0)} ms`]);for(const l of e.warnings??[])s.push(["Warning",l]);const o=(l,c)=>Object.assign(document.createElement(l),{textContent:c});Ki("about").replaceChildren(...s.flatMap(([l,c])=>[o("dt",l),o("dd",c)]))}}const On=i=>document.querySelector(`#${i}`),Ql=[0,.5,1,2,5,10];class rb{state=new mm;colours=new Cm;motion;view;current_step=null;socket;timeline;table;plots;cameras;words;editor;names;wand=null;noted="";tab="list";wanted=!1;before=0;recording=!1;recording_into="";latency=new km;latest=null;image_requested={frame:-1,at:0};constructor(t){const{state:e}=this,n=()=>this.draw_soon();this.motion=t.kind==="live"?new vs(t):new i0(t),this.motion.on_change=n,this.view=QE(t,e,this.colours,n),this.socket=new r0({opened:()=>this.opened(),text:r=>this.text(r),bytes:r=>this.bytes(r),lost:()=>this.editor.lost(),server_message:r=>this.said(r)},t.kind==="live"),On("view").append(this.view.element),e.trail_s=t.frame==="space"?1:2,this.timeline=new o0(e,()=>this.motion,r=>this.step(r)),this.table=new a0(e,this.colours),this.plots=new t0(e,this.colours,()=>this.motion,r=>this.seek(r)),this.cameras=new wm(e,this.colours,r=>this.say(r),r=>this.latency.drawn(r.sent_ms)),this.names=new Gm(On("stage"),e,r=>this.say(r)),this.words=new sb(()=>this.motion,this.colours,this.latency),this.editor=new Im(e,()=>this.motion,{send:r=>this.say(r),seek:r=>this.seek(r),show_tab:r=>this.show_tab(r)}),eb(t.job)&&(this.wand=new ib(t.job,this.cameras,r=>this.say(r))),e.on_change(n),e.on_change(()=>this.plots.update()),e.on_hover=n,this.wire_buttons(),Vm(this.view,e),this.take(t),t.kind==="recording"&&(e.time=this.motion.first);const s=matchMedia("(max-width: 800px)").matches;this.show_tab(t.kind==="live"&&t.cameras.length>0&&t.frame!=="image"&&!s?"pictures":"list"),new ResizeObserver(()=>this.resize()).observe(On("stage")),Um({state:e,scene:()=>this.motion.scene,editor:this.editor,timeline:this.timeline,names:this.names,seek:r=>this.seek(r),go_to:r=>this.seek(this.motion[r]),step:r=>this.step(r),show_tab:r=>this.show_tab(r)}),document.addEventListener("visibilitychange",()=>this.visible()),this.socket.connect()}opened(){this.visible(),this.cameras.ask(!0),this.ping(),this.motion.scene.can_edit&&this.fetch_scene(),this.editor.found()}say(t){return this.socket.send(t)}text(t){const e=t.indexOf(" "),n=e<0?t:t.slice(0,e),s=e<0?"":t.slice(e+1);n==="scene"?this.fetch_scene():n==="status"?this.take_status(JSON.parse(s)):n==="recording"?this.take_recording(s):n==="said"?this.said(s):n==="wand"?this.wand?.take(s):n==="ended"?this.said("The run has ended."):n==="pong"?this.latency.pong(s):this.editor.hear(n,s)}bytes(t){const e=K_(t);if(e===2&&this.motion instanceof vs)this.latest=new rp(t),this.motion.add(this.latest);else if(e===3){const n=q_(t),{scene:s}=this.motion;s.kind==="live"&&this.cameras.shown_image(n),(s.kind==="recording"||s.frame==="image"&&n.camera===(s.camera??0))&&this.take_video_image(n)}}fetching=!1;stale=!1;async fetch_scene(){if(this.stale=!0,!this.fetching){for(this.fetching=!0;this.stale;){this.stale=!1;try{this.take(await(await fetch("scene")).json())}catch{break}}this.fetching=!1}}take(t){if(t.kind!==this.motion.scene.kind||t.frame!==this.motion.scene.frame)return location.reload();const e=this.motion.last===0;this.motion instanceof vs?this.motion.take(t):this.motion.take(t),e&&t.kind==="recording"&&(this.state.time=Math.max(this.state.time,this.motion.first)),this.colours.take(t);const n=this.wand?.frame(t)??!1;this.view.take(t),n&&this.view.reset();const s=this.motion instanceof vs?this.motion:null,r=Math.max(1,t.instants??1),a=pd(t);this.table.say_what_counts(a),this.table.take(t,this.motion,o=>s?s.seen(o.id):a?(o.rows??0)/r:t.frame==="space"?(o.measured??0)/r:(o.measured??0)/Math.max(1,o.within??1)),this.cameras.take(t),this.names.take(t),this.plots.update(),this.editor.take(t),this.words.update(),this.draw_soon()}take_status(t){if(this.words.status=t,this.cameras.status(t.cameras??[],t.unsaved??!1),this.note(t.notes??[]),this.words.about(),this.motion instanceof vs&&this.tab==="list"){const e=this.motion;this.table.take(e.scene,e,n=>e.seen(n.id))}}take_recording(t){this.recording=t.startsWith("on"),this.recording_into=t.slice(3);const e=On("record");e.setAttribute("aria-pressed",`${this.recording}`),e.querySelector("span").textContent=this.recording?"Recording":"Record",e.title=this.recording?`into ${this.recording_into}; R ends it`:"Record (R)"}async take_video_image(t){if(this.image_requested.at=0,!t.jpeg||!(this.view instanceof go))return;const e=await createImageBitmap(t.jpeg);this.view.video_image?.image.close(),this.view.video_image={image:e,frame:t.frame};const{scene:n}=this.motion;n.size||(n.size=[t.width,t.height],this.view.take(n)),this.draw_soon()}draw_soon(){this.wanted||(this.wanted=!0,requestAnimationFrame(t=>this.draw(t)))}draw(t){this.wanted=!1;const{state:e,motion:n}=this,s=Math.min(.25,(t-this.before)/1e3);this.before=t,this.colours.dark!==e.dark&&(this.colours.dark=e.dark,document.documentElement.classList.toggle("light",!e.dark),this.table.draw(),this.words.legend()),n.scene.kind==="live"?e.stays_at_end?e.time=n.last:e.time<n.first&&(e.time=n.first):e.playing&&(this.play_on(s),this.draw_soon());const r=n.at(e.time);r&&(this.current_step=r),this.request_video_image(),this.view.draw(n,this.shown_moment()),this.latest&&(this.latency.drawn(this.latest.sent_ms),this.latest=null),this.timeline.draw(),this.plots.draw(),this.plots.visible&&n.scene.kind==="live"&&this.plots.update(),this.editor.draw(),this.show_buttons(),document.body.dataset.time=e.time.toFixed(4),document.body.dataset.rows=`${r?r.chunk.row_end[r.k]-r.chunk.begin(r.k):""}`}play_on(t){const{state:e,motion:n}=this;n.at(e.time)&&(e.time+=t*e.speed,!(e.time<n.last)&&(e.time=n.last,(n.scene.complete??!0)&&(e.playing=!1)))}shown_moment(){const t=this.view instanceof go?this.view.video_image:null;if(!t||!this.current_step)return this.current_step;const e=this.motion.at(this.state.time+(t.frame-this.current_step.chunk.index[this.current_step.k])/Math.max(.1,this.motion.scene.rate));return e&&Math.abs(e.chunk.index[e.k]-t.frame)<2?e:this.current_step}request_video_image(){const{current_step:t,view:e}=this;if(!this.motion.scene.video||!t||!(e instanceof go))return;const n=t.chunk.index[t.k],s=performance.now(),r=this.image_requested.at>0&&s-this.image_requested.at<1e3;n===this.image_requested.frame||r||(this.image_requested={frame:n,at:s},this.say(`video ${n} ${Math.max(320,Math.min(1920,160*Math.ceil(e.pixels_wide/160)))}`))}show_buttons(){const{state:t}=this;ge(On("theme"),t.dark?"☾":"☀"),On("labels").classList.toggle("on",t.labels),On("rig").classList.toggle("on",t.cameras),On("rays").classList.toggle("on",t.rays);const e=On("trails");e.classList.toggle("on",t.trail_s>0),ge(e,t.trail_s>0?`Trails ${t.trail_s} s`:"Trails"),this.words.live_facts()}note(t){const e=t.map(n=>n.slice(0,1).toUpperCase()+n.slice(1)).join(`
`);(e!==""||On("said").textContent===this.noted)&&this.said(e),this.noted=e}said(t){const e=On("said");e.textContent=t,e.hidden=t===""}ping(){if(this.motion.scene.kind!=="live"||!this.socket.open)return;const[t,e]=this.latency.ping();this.say(t),setTimeout(()=>this.ping(),e)}visible(){this.say(document.hidden?"sleep":"wake"),document.hidden||this.cameras.ask(!0)}seek(t){this.state.time=Math.max(this.motion.first,Math.min(this.motion.last,t)),this.state.stays_at_end=!1,this.state.changed()}step(t){this.state.playing=!1,this.state.stays_at_end=!1;const e=this.motion.at(this.state.time),n=e&&this.motion.neighbour(e,t>0?1:-1);n?this.seek(Ji(n)):this.state.changed()}show_tab(t){this.tab=t,document.body.dataset.tab=t;for(const e of document.querySelectorAll("#panel section"))e.classList.toggle("on",e.dataset.tab===t);for(const e of document.querySelectorAll("#tabs button"))e.setAttribute("aria-selected",`${e.dataset.tab===t}`);document.body.classList.toggle("pictures",t==="pictures"),this.plots.visible=t==="plot",this.plots.update(),this.table.draw(),t==="edits"&&this.editor.opened(),this.words.about()}resize(){const t=On("stage");this.view.resize(t.clientWidth,t.clientHeight);const{scene:e}=this.motion;e.kind==="live"&&e.frame==="image"&&(this.cameras.also={camera:e.camera??0,width:this.view.pixels_wide},this.cameras.ask()),this.draw_soon()}wire_buttons(){const{state:t}=this,e=(s,r)=>On(s).addEventListener("click",r),n=(s,r)=>e(s,()=>(r(),t.changed()));n("labels",()=>t.labels=!t.labels),n("rig",()=>t.cameras=!t.cameras),n("rays",()=>t.rays=!t.rays),n("theme",()=>t.dark=!t.dark),n("trails",()=>t.trail_s=Ql[(Ql.indexOf(t.trail_s)+1)%Ql.length]),e("reset",()=>this.view.reset());for(const s of["top","front","side"])e(s,()=>this.view.view_from?.(s));e("help",()=>On("keys").showModal()),e("record",()=>this.say(`record ${this.recording?"off":"on"}`));for(const s of document.querySelectorAll("#tabs button"))s.addEventListener("click",()=>this.show_tab(s.dataset.tab))}}async function ab(){history.replaceState(null,"","/");const i=await fetch("scene");if(!i.ok)throw new Error(await i.text());new rb(await i.json())}ab().catch(i=>{const t=On("said");t.hidden=!1,t.textContent=`Nothing to show: ${i instanceof Error?i.message:String(i)}`});

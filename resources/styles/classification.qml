<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis styleCategories="Symbology|Symbology3D" version="3.40.0" sync3DRendererTo2DRenderer="1">
  <renderer type="classified" attribute="Classification" pointSize="0.8" pointSizeUnit="MM" pointSizeMapUnitScale="3x:0,0,0,0,0,0" maximumScreenError="0.3" maximumScreenErrorUnit="MM" pointSymbol="1" drawOrder2d="1" renderAsTriangles="0" horizontalTriangleFilter="0" horizontalTriangleFilterThreshold="5" horizontalTriangleFilterUnit="MM">
    <categories>
      <category value="0" label="Created, never classified" color="176,176,176,255" pointSize="0" render="true"/>
      <category value="1" label="Unclassified" color="200,200,200,255" pointSize="0" render="true"/>
      <category value="2" label="Ground" color="181,138,90,255" pointSize="0" render="true"/>
      <category value="3" label="Low vegetation" color="183,217,139,255" pointSize="0" render="true"/>
      <category value="4" label="Medium vegetation" color="127,191,90,255" pointSize="0" render="true"/>
      <category value="5" label="High vegetation" color="63,143,58,255" pointSize="0" render="true"/>
      <category value="6" label="Building" color="208,67,47,255" pointSize="0" render="true"/>
      <category value="7" label="Low point (noise)" color="255,0,255,255" pointSize="0" render="true"/>
      <category value="9" label="Water" color="79,155,217,255" pointSize="0" render="true"/>
      <category value="10" label="Rail" color="122,90,140,255" pointSize="0" render="true"/>
      <category value="11" label="Road surface" color="138,138,138,255" pointSize="0" render="true"/>
      <category value="13" label="Wire, guard" color="232,212,77,255" pointSize="0" render="true"/>
      <category value="14" label="Wire, conductor" color="242,182,50,255" pointSize="0" render="true"/>
      <category value="15" label="Transmission tower" color="140,109,31,255" pointSize="0" render="true"/>
      <category value="16" label="Wire-structure connector" color="201,162,39,255" pointSize="0" render="true"/>
      <category value="17" label="Bridge deck" color="91,110,168,255" pointSize="0" render="true"/>
      <category value="18" label="High noise" color="255,102,255,255" pointSize="0" render="true"/>
      <category value="19" label="Overhead structure" color="160,82,45,255" pointSize="0" render="true"/>
      <category value="20" label="Ignored ground" color="217,195,165,255" pointSize="0" render="true"/>
      <category value="21" label="Snow" color="238,246,255,255" pointSize="0" render="true"/>
      <category value="22" label="Temporal exclusion" color="64,64,64,255" pointSize="0" render="true"/>
    </categories>
  </renderer>
  <blendMode>0</blendMode>
</qgis>
